/* ---- The step: implicit Euler, then what happens at its end --------------------------------------------------- */

/* Newton's method ends where changes are below this part of the largest values so far, or where the next one will be, as fast as they
   become smaller from the second on: the first also corrects what is affine. It ends too where they are small and become no smaller
   with a new matrix: then they are rounding. */
#define HY_RELATIVE 1e-12
#define HY_ABSOLUTE 1e-14
#define HY_ROUNDING 1e6
#define HY_ITERATIONS 40
#define HY_ROUNDS 50

static double hy_time(const @NAME@ *m, long long count)
{
    (void)m;
    return HY_START + (double)count * @NAME@_STEP;
}

static int hy_in_mode(const @NAME@ *m, int automaton, int mode)
{
    return m->z[hy_automaton_place[automaton]] == (double)mode;
}

static void hy_apply_pins(@NAME@ *m)
{
    for (int k = 0; k < HY_PINS; ++k) {
        if (m->pin_on[k]) {
            m->y[hy_pin_state[k]] = m->pin_value[k];
            m->yp[hy_pin_state[k]] = 0.0;
        }
    }
}

/* The states that modes fix, and their values. */
static void hy_pin(@NAME@ *m, double t)
{
    if (HY_PINS == 0) {
        return;
    }
    hy_assignments(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->values);
    for (int k = 0; k < HY_PINS; ++k) {
        m->pin_on[k] = (unsigned char)hy_in_mode(m, hy_pin_automaton[k], hy_pin_mode[k]);
        m->pin_value[k] = m->values[HY_ASSIGNMENTS + k];
    }
    hy_apply_pins(m);
}

/* Takes a change of the rates and of the other unknowns back; whether all of it is finite. */
static int hy_take(@NAME@ *m, double h, const double *change)
{
    double sum = 0.0;
    for (int run = 0; run < HY_RUNS; ++run) {
        if (hy_run_differential[run]) {
            for (int k = hy_run_first[run]; k < hy_run_end[run]; ++k) {
                sum += change[k];
                m->yp[k] -= change[k];
                m->y[k] = m->base[k] + h * m->yp[k];
            }
        } else {
            for (int k = hy_run_first[run]; k < hy_run_end[run]; ++k) {
                sum += change[k];
                m->y[k] -= change[k];
            }
        }
    }
    return fabs(sum) < HUGE_VAL;
}

/* The largest part of a change, relative to what counts as none. */
static double hy_size(@NAME@ *m, const double *change)
{
    double size = 0.0;
    for (int run = 0; run < HY_RUNS; ++run) {
        for (int k = hy_run_first[run]; k < hy_run_end[run]; ++k) {
            const double value = hy_run_differential[run] ? m->yp[k] : m->y[k];
            double small;
            m->largest[k] = hy_largest(m->largest[k], fabs(value));
            small = HY_RELATIVE * m->largest[k] + HY_ABSOLUTE;
            if (hy_run_differential[run]) {
                /* What matters of a rate is what it makes of its state in a step. */
                small = hy_largest(small, (HY_RELATIVE * fabs(m->y[k]) + HY_ABSOLUTE) * (1.0 / @NAME@_STEP));
            }
            if (fabs(change[k]) > size * small) {
                size = fabs(change[k]) / small;
            }
        }
    }
    return size;
}

/* Solves for the rates of the states and the other unknowns; with a step (kind 0) the states are base + h rate, without one
   (kind 1, h = 0) they stay. If all equations are affine in the unknowns (HY_CURVED is 0), one iteration with the factors of the
   present modes solves them. */
static int hy_solve(@NAME@ *m, double t, double h, int kind)
{
    double last = HUGE_VAL;
    int since = 2;
    if (HY_N == 0) {
        return @NAME@_OK;
    }
    hy_apply_pins(m);
    memcpy(m->base, kind == 0 ? m->before_y : m->y, sizeof m->base);
    for (int k = 0; k < HY_PINS; ++k) {
        if (m->pin_on[k]) {
            m->base[hy_pin_state[k]] = m->pin_value[k];
        }
    }
    for (int iteration = 0; iteration < HY_ITERATIONS; ++iteration) {
        double size, rate;
        int stalls;
        since += since < 2;
        hy_residual(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->residual);
        if (!hy_keeps(m, kind)) {
            const int status = hy_factor(m, t, h, kind);
            if (status != @NAME@_OK) {
                return status;
            }
            since = 0;
        }
        hy_substitute(m, kind, m->residual);
        if (!hy_take(m, h, m->residual)) {
            return @NAME@_NOT_FINITE;
        }
        if (HY_CURVED == 0) {
            hy_apply_pins(m);
            return @NAME@_OK;
        }
        size = hy_size(m, m->residual);
        rate = size / last;
        stalls = rate > 0.25;
        if (size <= 1.0 || (iteration > 1 && !stalls && size * rate <= 0.25) || (size <= HY_ROUNDING && stalls && since < 2)) {
            hy_apply_pins(m);
            return @NAME@_OK;
        }
        if (stalls) {
            m->fresh[kind] = 0;
        }
        last = size;
    }
    return @NAME@_NOT_SOLVED;
}

/* Whether a relation matters in the current modes. */
static int hy_matters(const @NAME@ *m, int relation)
{
    return hy_relation_automaton[relation] < 0 ||
           hy_in_mode(m, hy_relation_automaton[relation], hy_relation_mode[relation]);
}

static void hy_turn(@NAME@ *m)
{
    for (int k = 0; k < HY_RELATIONS; ++k) {
        if (m->flipped[k]) {
            m->z[k] = 1.0 - m->z[k];
        }
    }
}

/* Reactions fire together until nothing fires. */
static int hy_settle(@NAME@ *m, double t, int at_start)
{
    if (HY_RELATIONS == 0 && HY_REACTIONS == 0) {
        return @NAME@_OK;
    }
    for (int round = 0; round < HY_ROUNDS; ++round) {
        int any = 0, edges = 0, changed = 0;
        const int first = at_start && round == 0;
        hy_roots(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->roots);
        if (HY_SCHEDULED) {
            /* An instant that is known beforehand counts as passed at the step that ends there. */
            hy_roots(t + 1e-3 * @NAME@_STEP, m->y, m->yp, m->z, m->u, m->p, m->w, m->later);
        }
        for (int k = 0; k < HY_RELATIONS; ++k) {
            const double root = hy_relation_scheduled[k] ? m->later[k] : m->roots[k];
            const double truth = (root > 0.0 || (root == 0.0 && hy_relation_inclusive[k])) ? 1.0 : 0.0;
            m->flipped[k] = 0;
            if (hy_matters(m, k) && m->z[k] != truth) {
                m->z[k] = truth;
                changed = 1;
                m->flipped[k] = (unsigned char)hy_relation_equation[k];
                any |= hy_relation_equation[k];
            }
        }
        if (m->quiet && !changed) {
            /* Conditions are made of the memory, which is as it was when nothing fired. */
            return @NAME@_OK;
        }
        m->quiet = 0;
        hy_conditions(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->truths);
        for (int k = 0; k < HY_REACTIONS; ++k) {
            if (hy_reaction_kind[k] == 2) {
                edges = 1;
                m->z[hy_reaction_a[k]] = (!first && m->truths[k] != 0.0 && !m->conditions[k]) ? 1.0 : 0.0;
            }
        }
        if (edges) {
            hy_conditions(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->truths);
        }
        memset(m->left, 0, sizeof m->left);
        memset(m->clause, 0, sizeof m->clause);
        for (int k = 0; k < HY_REACTIONS; ++k) {
            const int now = m->truths[k] != 0.0, before = m->conditions[k];
            const int a = hy_reaction_a[k];
            m->fired[k] = 0;
            m->conditions[k] = (unsigned char)now;
            if (hy_reaction_kind[k] == 0 && now && hy_in_mode(m, a, hy_reaction_from[k]) && !m->left[a]) {
                m->left[a] = 1;
                m->fired[k] = 1;
            } else if (hy_reaction_kind[k] == 1 && now && !before && !first && !m->clause[a]) {
                m->clause[a] = 1;
                m->fired[k] = 1;
            } else if (hy_reaction_kind[k] == 3 && now) {
                m->broken = k;
                return @NAME@_ASSERT;
            }
            any |= m->fired[k];
        }
        if (!any) {
            for (int k = 0; k < HY_REACTIONS; ++k) {
                if (hy_reaction_kind[k] == 2) {
                    m->z[hy_reaction_a[k]] = 0.0;
                }
            }
            m->quiet = !edges;
            return @NAME@_OK;
        }
        hy_turn(m);
        hy_assignments(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->values);
        hy_turn(m);
        for (int k = 0; k < HY_REACTIONS; ++k) {
            if (m->fired[k]) {
                for (int n = hy_reaction_first[k]; n < hy_reaction_end[k]; ++n) {
                    (hy_assignment_memory[n] ? m->z : m->y)[hy_assignment_place[n]] = m->values[n];
                }
            }
        }
        for (int k = 0; k < HY_REACTIONS; ++k) {
            if (m->fired[k] && hy_reaction_kind[k] == 0) {
                m->z[hy_automaton_place[hy_reaction_a[k]]] = (double)hy_reaction_to[k];
            }
        }
        if (HY_CURVED > 0) {
            m->fresh[0] = m->fresh[1] = 0;
        }
        hy_pin(m, t);
        const int status = hy_solve(m, t, 0.0, 1);
        if (status != @NAME@_OK) {
            return status;
        }
    }
    m->unsettled += 1;
    return @NAME@_OK;
}

/* Whether a clock ticks at this instant. */
static int hy_ticks_now(const @NAME@ *m, int clock)
{
    return m->count >= hy_clock_phase[clock] && (m->count - hy_clock_phase[clock]) % hy_clock_period[clock] == 0;
}

/* Whether a clock ticks or a held value changes at this instant. */
static int hy_due(const @NAME@ *m)
{
    int due = 0;
    for (int k = 0; k < HY_CLOCKS; ++k) {
        due |= hy_ticks_now(m, k);
    }
    for (int k = 0; k < HY_HOLDS; ++k) {
        due |= m->pending_at[k] == m->count;
    }
    return due;
}

/* Clocks tick on the values before the events of the instant; whether something that equations read has changed. */
static int hy_tick(@NAME@ *m, double t)
{
    int changed = 0;
    m->quiet = 0;
    memcpy(m->now_z, m->z, sizeof m->z);
    memcpy(m->z, m->left_z, sizeof m->z);
    for (int k = 0; k < HY_CLOCKS; ++k) {
        const int clock = hy_clock_order[k];
        if (!hy_ticks_now(m, clock)) {
            continue;
        }
        memcpy(m->after_z, m->z, sizeof m->z);
        hy_ticks(clock, t, m->left_y, m->left_yp, m->z, m->u, m->p, m->w, m->after_z);
        memcpy(m->z, m->after_z, sizeof m->z);
        for (int n = 0; n < HY_HOLDS; ++n) {
            if (hy_hold_clock[n] == clock) {
                m->pending[n] = m->z[hy_hold_source[n]];
                m->pending_at[n] = m->count + hy_clock_delay[clock];
            }
        }
    }
    for (int n = 0; n < HY_HOLDS; ++n) {
        if (m->pending_at[n] == m->count) {
            changed |= hy_hold_read[n] && m->z[hy_hold_target[n]] != m->pending[n];
            m->z[hy_hold_target[n]] = m->pending[n];
            m->pending_at[n] = -1;
        }
    }
    for (int k = 0; k < HY_MEMORY; ++k) {
        if (m->z[k] == m->left_z[k]) {
            m->z[k] = m->now_z[k];
        }
    }
    return changed;
}

/* Everything that happens at the end of a step, or at the start. */
static int hy_instant(@NAME@ *m, int at_start)
{
    const double t = hy_time(m, m->count);
    const int due = hy_due(m);
    int status;
    if (due) {
        memcpy(m->left_y, m->y, sizeof m->y);
        memcpy(m->left_yp, m->yp, sizeof m->yp);
        memcpy(m->left_z, m->z, sizeof m->z);
    }
    status = hy_settle(m, t, at_start);
    if (status == @NAME@_OK && due && hy_tick(m, t)) {
        status = hy_solve(m, t, 0.0, 1);
        if (status == @NAME@_OK) {
            status = hy_settle(m, t, 0);
        }
    }
    if (status == @NAME@_OK) {
        hy_outputs(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->out);
    }
    return status;
}

/* Whether a parameter or an input may have a value. */
static int hy_allowed(int place, double value)
{
    return fabs(value) < HUGE_VAL && value >= hy_low[place] && value <= hy_high[place] &&
           (!hy_whole[place] || value == floor(value));
}

int @NAME@_init(@NAME@ *m)
{
    memset(m, 0, sizeof *m);
    memcpy(m->p, hy_start_p, sizeof m->p);
    memcpy(m->y, hy_start_y, sizeof m->y);
    memcpy(m->yp, hy_start_yp, sizeof m->yp);
    memcpy(m->z, hy_start_z, sizeof m->z);
    memcpy(m->given, hy_given, sizeof m->given);
    for (int k = 0; k < HY_HOLDS; ++k) {
        m->pending_at[k] = -1;
    }
    hy_parameters(m->given, m->p);
    hy_pin(m, hy_time(m, 0));
    return hy_instant(m, 1);
}

int @NAME@_step(@NAME@ *m)
{
    int status;
    if (m->set) {
        hy_parameters(m->given, m->p);
        for (int k = 0; k < HY_PARAMETERS; ++k) {
            if (m->p[k] < hy_low[k] || m->p[k] > hy_high[k]) {
                return @NAME@_NOT_ALLOWED;
            }
        }
        m->set = m->quiet = 0;
    }
    memcpy(m->before_y, m->y, sizeof m->y);
    memcpy(m->before_yp, m->yp, sizeof m->yp);
    memcpy(m->before_z, m->z, sizeof m->z);
    memcpy(m->before_conditions, m->conditions, sizeof m->conditions);
    memcpy(m->before_pin_on, m->pin_on, sizeof m->pin_on);
    memcpy(m->before_pin_value, m->pin_value, sizeof m->pin_value);
    memcpy(m->before_pending, m->pending, sizeof m->pending);
    memcpy(m->before_pending_at, m->pending_at, sizeof m->pending_at);
    for (int run = 0; run < HY_RUNS; ++run) {
        for (int k = hy_run_first[run]; hy_run_differential[run] && k < hy_run_end[run]; ++k) {
            m->y[k] += @NAME@_STEP * m->yp[k];
        }
    }
    status = hy_solve(m, hy_time(m, m->count + 1), @NAME@_STEP, 0);
    if (status == @NAME@_OK) {
        m->count += 1;
        status = hy_instant(m, 0);
        m->count -= 1;
    }
    if (status != @NAME@_OK) {
        memcpy(m->y, m->before_y, sizeof m->y);
        memcpy(m->yp, m->before_yp, sizeof m->yp);
        memcpy(m->z, m->before_z, sizeof m->z);
        memcpy(m->conditions, m->before_conditions, sizeof m->conditions);
        memcpy(m->pin_on, m->before_pin_on, sizeof m->pin_on);
        memcpy(m->pin_value, m->before_pin_value, sizeof m->pin_value);
        memcpy(m->pending, m->before_pending, sizeof m->pending);
        memcpy(m->pending_at, m->before_pending_at, sizeof m->pending_at);
        m->fresh[0] = m->fresh[1] = 0;
        m->quiet = 0;
        return status;
    }
    m->count += 1;
    return @NAME@_OK;
}

double @NAME@_time(const @NAME@ *m)
{
    return hy_time(m, m->count);
}

int @NAME@_set(@NAME@ *m, int input, double value)
{
    if (input < 0 || input >= @NAME@_INPUTS) {
        return @NAME@_NO_SUCH;
    }
    if (!(fabs(value) < HUGE_VAL) || (!hy_input_column[input] && !hy_allowed(hy_input_place[input], value))) {
        return @NAME@_NOT_ALLOWED;
    }
    if (hy_input_column[input]) {
        /* A column of a record, read linearly and as it is held. */
        m->u[hy_input_place[input]] = value;
        m->u[hy_input_place[input] + 1] = value;
    } else {
        if (hy_input_coefficient[input] && m->p[hy_input_place[input]] != value) {
            m->fresh[0] = m->fresh[1] = 0;
        }
        m->p[hy_input_place[input]] = value;
        m->set = 1;
    }
    return @NAME@_OK;
}

int @NAME@_set_parameter(@NAME@ *m, int parameter, double value)
{
    if (parameter < 0 || parameter >= @NAME@_PARAMETERS) {
        return @NAME@_NO_SUCH;
    }
    if (!hy_allowed(hy_parameter_place[parameter], value)) {
        return @NAME@_NOT_ALLOWED;
    }
    m->p[hy_parameter_place[parameter]] = value;
    m->given[hy_parameter_place[parameter]] = 1;
    m->fresh[0] = m->fresh[1] = 0;
    m->set = 1;
    return @NAME@_OK;
}

double @NAME@_get_parameter(const @NAME@ *m, int parameter)
{
    return parameter < 0 || parameter >= @NAME@_PARAMETERS ? (double)NAN : m->p[hy_parameter_place[parameter]];
}

double @NAME@_get(const @NAME@ *m, int output)
{
    return output < 0 || output >= @NAME@_OUTPUTS ? (double)NAN : m->out[output];
}

long long @NAME@_unsettled(const @NAME@ *m)
{
    return m->unsettled;
}

const char *@NAME@_message(const @NAME@ *m, int status)
{
    switch (status) {
    case @NAME@_OK:
        return "in order";
    case @NAME@_NOT_SOLVED:
        return "the equations of a step have no solution that Newton's method finds";
    case @NAME@_SINGULAR:
        return "the equations of a step do not determine all unknowns";
    case @NAME@_NOT_FINITE:
        return "an equation has no finite value";
    case @NAME@_ASSERT:
        return hy_reaction_text[m->broken];
    case @NAME@_NO_SUCH:
        return "no such input or parameter";
    case @NAME@_NOT_ALLOWED:
        return "a value is not finite, or outside the bounds of its parameter or of one that follows from it";
    default:
        return "no such status";
    }
}
