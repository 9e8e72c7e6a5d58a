/* P3 and P5: two masses with a gap between them, the first moved by a drive; of one gap, or of many.
 *
 *   backlash RTOL GAP              one gap in m: its events until 10 s
 *   backlash RTOL FIRST LAST N     N gaps from FIRST to LAST: position of the second mass and distance at 10 s of each, and
 *                                  the count of its events, as samples; T is the gap
 *
 * States: both positions, both speeds. */
#include "reference.h"
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double M1 = 50, M2 = 200, K = 1e8, D = 1e4, KP = 5e6, KD = 2e4, VISCOUS = 2000, STOP = 10;

static double gap;
/* Which side touches: -1, 0 (none), +1. */
static int contact;

static double force(const double *y) {
  return contact ? K * (y[0] - y[1] - contact * gap) + D * (y[2] - y[3]) : 0.0;
}

static double drive(double t, const double *y) {
  return KP * (0.01 * sin(2 * PI * t) - y[0]) + KD * (0.01 * 2 * PI * cos(2 * PI * t) - y[2]);
}

static void rates(double t, const double *y, double *yp) {
  double f = force(y);
  yp[0] = y[2];
  yp[1] = y[3];
  yp[2] = (drive(t, y) - f) / M1;
  yp[3] = (f - VISCOUS * y[3]) / M2;
}

static int residual(double t, N_Vector Y, N_Vector YP, N_Vector R, void *user) {
  (void)user;
  double *r = V(R);
  const double *yp = V(YP);
  rates(t, V(Y), r);
  for (int i = 0; i < 4; i++) r[i] = yp[i] - r[i];
  return 0;
}

static int jacobian(double t, double cj, N_Vector Y, N_Vector YP, N_Vector R, SUNMatrix J, void *user, N_Vector a, N_Vector b, N_Vector c) {
  (void)t, (void)Y, (void)YP, (void)R, (void)user, (void)a, (void)b, (void)c;
  double k = contact ? K : 0.0, d = contact ? D : 0.0;
  const double by_column[16] = {
      cj, 0, (KP + k) / M1, -k / M2,
      0, cj, -k / M1, k / M2,
      -1, 0, cj + (KD + d) / M1, -d / M2,
      0, -1, -d / M1, cj + (d + VISCOUS) / M2,
  };
  memcpy(SUNDenseMatrix_Data(J), by_column, sizeof by_column);
  return 0;
}

static int roots(double t, N_Vector Y, N_Vector YP, double *g, void *user) {
  (void)t, (void)YP, (void)user;
  double distance = V(Y)[0] - V(Y)[1];
  g[0] = distance - gap;
  g[1] = distance + gap;
  return 0;
}

enum { MOST = 4000 };
static double events[MOST];
static int found;
static long steps;

static void *ida;
static N_Vector y, yp;

static void begin_again(double t) {
  rates(t, V(y), V(yp));
  CHECK(IDAReInit(ida, t, y, yp));
}

static void solve(double of_gap) {
  long part = 0;
  double t = 0;
  gap = of_gap;
  contact = found = 0;
  constant(0.0, y);
  begin_again(0);
  for (;;) {
    int how = IDASolve(ida, STOP, &t, y, yp, IDA_NORMAL), direction[2];
    CHECK(how);
    CHECK(IDAGetNumSteps(ida, &part));
    steps += part;
    if (how != IDA_ROOT_RETURN) return;
    if (found == MOST) exit(4);
    events[found++] = t;
    CHECK(IDAGetRootInfo(ida, direction));
    contact = direction[0] > 0 ? 1 : direction[1] < 0 ? -1 : 0;
    begin_again(t);
  }
}

int main(int count, char **words) {
  if (count != 3 && count != 5) return 1;
  double rtol = atof(words[1]), first = atof(words[2]);
  int cases = count == 5 ? atoi(words[4]) : 1;
  double last = count == 5 ? atof(words[3]) : first;
  SUNContext context;
  CHECK(SUNContext_Create(SUN_COMM_NULL, &context));
  y = vector(4, context);
  yp = vector(4, context);
  ida = IDACreate(context);
  CHECK(IDAInit(ida, residual, 0, y, yp));
  CHECK(IDASStolerances(ida, rtol, 1e-2 * rtol));
  SUNMatrix matrix = SUNDenseMatrix(4, 4, context);
  CHECK(IDASetLinearSolver(ida, SUNLinSol_Dense(y, matrix, context), matrix));
  CHECK(IDASetJacFn(ida, jacobian));
  CHECK(IDARootInit(ida, 2, roots));
  CHECK(IDASetStopTime(ida, STOP));
  CHECK(IDASetMaxNumSteps(ida, 10000000));
  Sample *ends = malloc((size_t)cases * sizeof *ends);
  if (!ends) return 3;
  double begin = cpu();
  for (int i = 0; i < cases; i++) {
    double of_gap = cases == 1 ? first : first + (last - first) * i / (cases - 1);
    solve(of_gap);
    ends[i] = (Sample){of_gap, V(y)[1], V(y)[0] - V(y)[1], found};
    if (i + 1 < cases) CHECK(IDASetStopTime(ida, STOP));
  }
  double end = cpu();
  print_run(end - begin, steps);
  if (cases > 1) print_samples(ends, cases);
  else
    for (int i = 0; i < found; i++) printf("event %.17g\n", events[i]);
  return 0;
}
