/* P2: a saddle with Coulomb friction, drawn through a spring and a damper by a sine.
 *
 *   stick_slip RTOL
 *
 * States: position, speed. Events: every transition between stick and slip, until 10 s. */
#include "reference.h"
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double MASS = 100, STIFFNESS = 1e6, DAMPING = 500, VISCOUS = 100, COULOMB = 300, STATIC = 400, STOP = 10;

/* 0 while it sticks, else the direction of the motion. */
static int slip;

static double pull(double t, double x, double v) {
  return STIFFNESS * (2e-3 * sin(2 * PI * t) - x) + DAMPING * (2e-3 * 2 * PI * cos(2 * PI * t) - v);
}

static double acceleration(double t, double x, double v) {
  return slip ? (pull(t, x, v) - slip * COULOMB - VISCOUS * v) / MASS : 0.0;
}

static int residual(double t, N_Vector Y, N_Vector YP, N_Vector R, void *user) {
  (void)user;
  const double *y = V(Y), *yp = V(YP);
  V(R)[0] = yp[0] - y[1];
  V(R)[1] = yp[1] - acceleration(t, y[0], y[1]);
  return 0;
}

static int jacobian(double t, double cj, N_Vector Y, N_Vector YP, N_Vector R, SUNMatrix J, void *user, N_Vector a, N_Vector b, N_Vector c) {
  (void)t, (void)Y, (void)YP, (void)R, (void)user, (void)a, (void)b, (void)c;
  double *value = SUNDenseMatrix_Data(J);
  value[0] = cj;
  value[1] = slip ? STIFFNESS / MASS : 0.0;
  value[2] = -1.0;
  value[3] = cj + (slip ? (DAMPING + VISCOUS) / MASS : 0.0);
  return 0;
}

static int roots(double t, N_Vector Y, N_Vector YP, double *g, void *user) {
  (void)YP, (void)user;
  const double *y = V(Y);
  double force = pull(t, y[0], y[1]);
  g[0] = slip ? y[1] : force - STATIC;
  g[1] = slip ? 1.0 : force + STATIC;
  return 0;
}

int main(int count, char **words) {
  if (count < 2) return 1;
  double rtol = atof(words[1]);
  SUNContext context;
  CHECK(SUNContext_Create(SUN_COMM_NULL, &context));
  N_Vector y = vector(2, context), yp = vector(2, context);
  void *ida = IDACreate(context);
  CHECK(IDAInit(ida, residual, 0, y, yp));
  CHECK(IDASStolerances(ida, rtol, 1e-2 * rtol));
  SUNMatrix matrix = SUNDenseMatrix(2, 2, context);
  CHECK(IDASetLinearSolver(ida, SUNLinSol_Dense(y, matrix, context), matrix));
  CHECK(IDASetJacFn(ida, jacobian));
  CHECK(IDARootInit(ida, 2, roots));
  CHECK(IDASetStopTime(ida, STOP));
  CHECK(IDASetMaxNumSteps(ida, 10000000));
  CHECK(IDASetNoInactiveRootWarn(ida));
  static double events[1000];
  int found = 0;
  long steps = 0, part = 0;
  double t = 0, begin = cpu();
  for (;;) {
    int how = IDASolve(ida, STOP, &t, y, yp, IDA_NORMAL);
    CHECK(how);
    CHECK(IDAGetNumSteps(ida, &part));
    if (how != IDA_ROOT_RETURN) break;
    steps += part;
    if (found == 1000) return 4;
    events[found++] = t;
    slip = slip ? 0 : pull(t, V(y)[0], V(y)[1]) > 0 ? 1 : -1;
    V(y)[1] = 0.0;
    V(yp)[0] = 0.0;
    V(yp)[1] = acceleration(t, V(y)[0], 0.0);
    CHECK(IDAReInit(ida, t, y, yp));
  }
  double end = cpu();
  print_run(end - begin, steps + part);
  for (int i = 0; i < found; i++) printf("event %.17g\n", events[i]);
  return 0;
}
