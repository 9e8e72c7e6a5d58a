/* ---- Linear equations: factors with an exchange of rows, where the fixed order does not serve ------------------- */

/* A pivot of the order of elimination is taken if it is not smaller than this part of the largest in its column. */
#define HY_PIVOT 0.1

/* The same matrix. Equations and unknowns are in the order of `equation_at` and `unknown_at`; rows are scaled, and exchanged where a
   pivot is small. */
static int hy_factor_exchanging(@NAME@ *m, double h, int kind)
{
    double *a = m->matrix[kind];
    memset(a, 0, sizeof m->matrix[kind]);
    for (int k = 0; k < HY_PARTIALS; ++k) {
        double *value = &a[hy_partial_row[k] * HY_N + hy_partial_column[k]];
        if (hy_partial_kind[k] != 2) {
            *value += hy_partial_kind[k] == 3 ? h * m->partials[k] : m->partials[k];
        }
    }
    for (int row = 0; row < HY_N; ++row) {
        double most = 0.0;
        for (int column = 0; column < HY_N; ++column) {
            most = fmax(most, fabs(a[row * HY_N + column]));
        }
        if (!(most > 0.0) || most > 1e300) {
            return @NAME@_SINGULAR;
        }
        m->scale[kind][row] = 1.0 / most;
        for (int column = 0; column < HY_N; ++column) {
            a[row * HY_N + column] /= most;
        }
    }
    for (int row = 0; row < HY_N; ++row) {
        m->equation[kind][row] = (unsigned short)hy_equation_at[row];
    }
    for (int k = 0; k < HY_N; ++k) {
        int pivot = k;
        for (int row = k + 1; row < HY_N; ++row) {
            if (fabs(a[row * HY_N + k]) > fabs(a[pivot * HY_N + k])) {
                pivot = row;
            }
        }
        if (fabs(a[k * HY_N + k]) >= HY_PIVOT * fabs(a[pivot * HY_N + k])) {
            pivot = k;
        }
        if (!(fabs(a[pivot * HY_N + k]) > 1e-300)) {
            return @NAME@_SINGULAR;
        }
        if (pivot != k) {
            const unsigned short equation = m->equation[kind][k];
            const double scale = m->scale[kind][k];
            m->equation[kind][k] = m->equation[kind][pivot];
            m->equation[kind][pivot] = equation;
            m->scale[kind][k] = m->scale[kind][pivot];
            m->scale[kind][pivot] = scale;
            for (int column = 0; column < HY_N; ++column) {
                const double other = a[k * HY_N + column];
                a[k * HY_N + column] = a[pivot * HY_N + column];
                a[pivot * HY_N + column] = other;
            }
        }
        m->inverse[kind][k] = 1.0 / a[k * HY_N + k];
        for (int row = k + 1; row < HY_N; ++row) {
            const double factor = a[row * HY_N + k] / a[k * HY_N + k];
            a[row * HY_N + k] = factor;
            if (factor != 0.0) {
                for (int column = k + 1; column < HY_N; ++column) {
                    a[row * HY_N + column] -= factor * a[k * HY_N + column];
                }
            }
        }
    }
    /* The numbers that are not zero, those below the diagonal first: to the left in their row, with their columns. */
    for (int row = 0; row < HY_N; ++row) {
        double *values = &a[row * HY_N];
        unsigned short *columns = &m->column[kind][row * HY_N];
        int count = 0;
        m->first[kind][row] = 0;
        for (int column = 0; column < HY_N; ++column) {
            if (column == row) {
                m->first[kind][row] = count;
            } else if (values[column] != 0.0) {
                values[count] = values[column];
                columns[count++] = (unsigned short)column;
            }
        }
        m->last[kind][row] = count;
    }
    return @NAME@_OK;
}

static void hy_substitute_exchanged(@NAME@ *m, int kind, double *b)
{
    double *x = m->solution;
    for (int row = 0; row < HY_N; ++row) {
        const double *values = &m->matrix[kind][row * HY_N];
        const unsigned short *columns = &m->column[kind][row * HY_N];
        const int count = m->first[kind][row];
        double sum = b[m->equation[kind][row]] * m->scale[kind][row];
        for (int k = 0; k < count; ++k) {
            sum -= values[k] * x[columns[k]];
        }
        x[row] = sum;
    }
    for (int row = HY_N - 1; row >= 0; --row) {
        const double *values = &m->matrix[kind][row * HY_N];
        const unsigned short *columns = &m->column[kind][row * HY_N];
        const int count = m->last[kind][row];
        double sum = x[row];
        for (int k = m->first[kind][row]; k < count; ++k) {
            sum -= values[k] * x[columns[k]];
        }
        x[row] = sum * m->inverse[kind][row];
    }
    for (int k = 0; k < HY_N; ++k) {
        b[hy_unknown_at[k]] = x[k];
    }
}

/* ---- Linear equations: the factors that are kept ---------------------------------------------------------------- */

/* Whether the factors that are kept are those of the present modes and truths of relations. */
static int hy_keeps(const @NAME@ *m, int kind)
{
    int same = m->fresh[kind];
    for (int k = 0; k < HY_MODES; ++k) {
        same &= m->mode[kind][k] == m->z[hy_mode_place[k]];
    }
    return same;
}

static int hy_factor(@NAME@ *m, double t, double h, int kind)
{
    int status = @NAME@_OK;
    hy_residual_partials(t, m->y, m->yp, m->z, m->u, m->p, m->w, m->partials);
    m->in_order[kind] = (unsigned char)hy_eliminate(m->partials, h, m->factors[kind]);
    if (!m->in_order[kind]) {
        status = hy_factor_exchanging(m, h, kind);
    }
    for (int k = 0; k < HY_MODES; ++k) {
        m->mode[kind][k] = m->z[hy_mode_place[k]];
    }
    m->fresh[kind] = status == @NAME@_OK;
    return status;
}

static void hy_substitute(@NAME@ *m, int kind, double *b)
{
    if (m->in_order[kind]) {
        hy_substitute_in_order(m->factors[kind], b);
    } else {
        hy_substitute_exchanged(m, kind, b);
    }
}
