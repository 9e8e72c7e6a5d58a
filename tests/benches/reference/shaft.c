/* P1 and P4: a steel shaft of N cells between a motor and a load, with a torque step or in a sampled P-PI loop.
 *
 *   shaft N RTOL [SAMPLE_TIME [1]]
 *
 * The sampled loop does not restart IDA at a tick: the error test sees to the jump of the torque. That takes 0.6 times the
 * time of a restart at each tick (1 ms), with smaller errors; at tight tolerances a restart, asked for by the last
 * argument, is quicker. KLU in natural order finds no fill in the order of states
 * below, and takes 0.8 times the time of COLAMD and AMD.
 *
 * States: the angles of all nodes, then their speeds. Samples: speed of the motor, speed of the load, twist, every 10 ms until 1 s. */
#include "reference.h"
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { NATURAL = 2 };

typedef struct {
  long nodes;
  double *inertia, *stiffness, *damping; /* of the nodes; of the elements between them */
  double torque;
} Shaft;

static const double BRAKE = 0.5, RETARDATION = 2e-5;

static Shaft shaft(long cells) {
  Shaft s = {.nodes = cells + 2, .torque = 10.0};
  s.inertia = numbers(s.nodes);
  s.stiffness = numbers(s.nodes);
  s.damping = numbers(s.nodes);
  double section = PI * pow(0.032, 4) / 32, length = 1.0 / (double)cells;
  for (long i = 0; i < s.nodes; i++) s.inertia[i] = 7850 * section * length;
  s.inertia[0] = s.inertia[s.nodes - 1] = 5e-3;
  for (long i = 0; i < s.nodes - 1; i++) {
    int at_an_end = i == 0 || i == s.nodes - 2;
    s.stiffness[i] = (at_an_end ? 2 : 1) * 80e9 * section / length;
    s.damping[i] = RETARDATION * s.stiffness[i];
  }
  return s;
}

static int residual(double t, N_Vector Y, N_Vector YP, N_Vector R, void *user) {
  (void)t;
  const Shaft *s = user;
  long m = s->nodes, last = m - 1;
  const double *angle = V(Y), *speed = angle + m, *angle_rate = V(YP), *speed_rate = angle_rate + m;
  double *r = V(R), before = -s->torque;
  for (long i = 0; i < last; i++) {
    double after = s->stiffness[i] * (angle[i + 1] - angle[i]) + s->damping[i] * (speed[i + 1] - speed[i]);
    r[i] = angle_rate[i] - speed[i];
    r[m + i] = s->inertia[i] * speed_rate[i] - (after - before);
    before = after;
  }
  r[last] = angle_rate[last] - speed[last];
  r[m + last] = s->inertia[last] * speed_rate[last] + BRAKE * speed[last] + before;
  return 0;
}

static int jacobian(double t, double cj, N_Vector Y, N_Vector YP, N_Vector R, SUNMatrix J, void *user, N_Vector a, N_Vector b, N_Vector c) {
  (void)t, (void)Y, (void)YP, (void)R, (void)a, (void)b, (void)c;
  const Shaft *s = user;
  long m = s->nodes;
  sunindextype *start = SM_INDEXPTRS_S(J), *row = SM_INDEXVALS_S(J), z = 0;
  double *value = SM_DATA_S(J);
#define ENTRY(at, number) (row[z] = (at), value[z++] = (number))
  for (long i = 0; i < m; i++) {
    int first = i == 0, last = i == m - 1;
    double left = first ? 0 : s->stiffness[i - 1], right = last ? 0 : s->stiffness[i];
    start[i] = z;
    ENTRY(i, cj);
    if (!first) ENTRY(m + i - 1, -left);
    ENTRY(m + i, left + right);
    if (!last) ENTRY(m + i + 1, -right);
  }
  for (long i = 0; i < m; i++) {
    int first = i == 0, last = i == m - 1;
    double left = first ? 0 : s->damping[i - 1], right = last ? 0 : s->damping[i];
    start[m + i] = z;
    ENTRY(i, -1.0);
    if (!first) ENTRY(m + i - 1, -left);
    ENTRY(m + i, cj * s->inertia[i] + left + right + (last ? BRAKE : 0.0));
    if (!last) ENTRY(m + i + 1, -right);
  }
  start[2 * m] = z;
  return 0;
}

static Sample sample(const Shaft *s, double t, const double *y) {
  long m = s->nodes;
  return (Sample){t, y[m], y[2 * m - 1], y[0] - y[m - 1]};
}

/* y' at the start: the residual is linear in it. */
static void set_rates(Shaft *s, N_Vector y, N_Vector yp, N_Vector r) {
  constant(0.0, yp);
  residual(0, y, yp, r, s);
  for (long i = 0; i < s->nodes; i++) {
    V(yp)[i] = -V(r)[i];
    V(yp)[s->nodes + i] = -V(r)[s->nodes + i] / s->inertia[i];
  }
}

int main(int count, char **words) {
  if (count < 3) return 1;
  Shaft s = shaft(atol(words[1]));
  double rtol = atof(words[2]), sample_time = count > 3 ? atof(words[3]) : 0;
  int restarts = count > 4;
  long n = 2 * s.nodes;
  SUNContext context;
  CHECK(SUNContext_Create(SUN_COMM_NULL, &context));
  N_Vector y = vector(n, context), yp = vector(n, context), r = vector(n, context);
  void *ida = IDACreate(context);
  if (sample_time > 0) s.torque = 3.0;
  set_rates(&s, y, yp, r);
  CHECK(IDAInit(ida, residual, 0, y, yp));
  CHECK(IDASStolerances(ida, rtol, 1e-2 * rtol));
  CHECK(IDASetUserData(ida, &s));
  SUNMatrix matrix = SUNSparseMatrix(n, n, 8 * s.nodes, CSC_MAT, context);
  SUNLinearSolver solver = SUNLinSol_KLU(y, matrix, context);
  CHECK(SUNLinSol_KLUSetOrdering(solver, NATURAL));
  CHECK(IDASetLinearSolver(ida, solver, matrix));
  CHECK(IDASetJacFn(ida, jacobian));
  CHECK(IDASetMaxNumSteps(ida, 100000000));
  static Sample samples[101];
  int taken = 0;
  long steps = 0, part = 0;
  double t = 0, integral = 0, begin = cpu();
  if (sample_time > 0) {
    long ticks = lround(1.0 / sample_time), every = lround(0.01 / sample_time);
    for (long k = 1; k <= ticks; k++) {
      double next = (double)k * sample_time;
      CHECK(IDASetStopTime(ida, next));
      CHECK(IDASolve(ida, next, &t, y, yp, IDA_NORMAL));
      if (k % every == 0) samples[taken++] = sample(&s, t, V(y));
      double error = 10.0 * (1.0 - V(y)[0]) - V(y)[s.nodes];
      integral += sample_time * error;
      s.torque = fmax(-30.0, fmin(30.0, 0.3 * error + 3.0 * integral));
      if (!restarts) continue;
      set_rates(&s, y, yp, r);
      CHECK(IDAGetNumSteps(ida, &part));
      steps += part;
      CHECK(IDAReInit(ida, t, y, yp));
      CHECK(IDASetInitStep(ida, 1e-7));
    }
  } else {
    CHECK(IDASetStopTime(ida, 1.0));
    for (int k = 1; k <= 100; k++) {
      CHECK(IDASolve(ida, 0.01 * k, &t, y, yp, IDA_NORMAL));
      samples[taken++] = sample(&s, t, V(y));
    }
  }
  double end = cpu();
  CHECK(IDAGetNumSteps(ida, &part));
  print_run(end - begin, steps + part);
  print_samples(samples, taken);
  return 0;
}
