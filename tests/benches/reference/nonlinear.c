/* The nonlinear shaft of N cells: cubic stiffening and Stribeck friction in every node; with INDEX_1 = 1 the torque of every
 * element follows from an implicit law, angle = torque/k + a torque^3.
 *
 *   nonlinear N RTOL INDEX_1
 *
 * KLU in natural order finds no fill where the states are angles and speeds alone; with the torques COLAMD is quickest.
 *
 * States: angles, speeds, and the torques of the implicit law. Samples as in shaft.c. */
#include "reference.h"
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const double BRAKE = 0.5, TORQUE = 10, COULOMB = 2e-3, STATIC = 4e-3, STRIBECK = 1.0, SMOOTH = 1e-2, CUBIC = 1e9, CUBIC_TORQUE = 2e-9;

enum { COLAMD = 1, NATURAL = 2 };

static int m, implicit;
static double *inertia, *stiffness, *damping;

static inline double friction(double w, double *slope) {
  double decay = exp(-(w / STRIBECK) * (w / STRIBECK)), sign = tanh(w / SMOOTH), level = COULOMB + (STATIC - COULOMB) * decay;
  *slope = (STATIC - COULOMB) * decay * (-2 * w / (STRIBECK * STRIBECK)) * sign + level * (1 - sign * sign) / SMOOTH;
  return level * sign;
}

static int residual(double t, N_Vector Y, N_Vector YP, N_Vector R, void *user) {
  (void)t, (void)user;
  const double *angle = V(Y), *speed = angle + m, *torque = speed + m, *rate = V(YP);
  double *r = V(R), before = -TORQUE;
  for (int i = 0; i < m; i++) {
    double after = 0, slope;
    if (i < m - 1) {
      double twist = angle[i + 1] - angle[i];
      double elastic = implicit ? torque[i] : stiffness[i] * twist * (1 + CUBIC * twist * twist);
      if (implicit) r[2 * m + i] = twist - torque[i] / stiffness[i] - CUBIC_TORQUE * torque[i] * torque[i] * torque[i];
      after = elastic + damping[i] * (speed[i + 1] - speed[i]);
    }
    r[i] = rate[i] - speed[i];
    r[m + i] = inertia[i] * rate[m + i] - (after - before - friction(speed[i], &slope));
    before = after;
  }
  r[2 * m - 1] += BRAKE * speed[m - 1];
  return 0;
}

static double stiffness_at(const double *angle, int element) {
  if (implicit || element < 0 || element > m - 2) return 0;
  double twist = angle[element + 1] - angle[element];
  return stiffness[element] * (1 + 3 * CUBIC * twist * twist);
}

static int jacobian(double t, double cj, N_Vector Y, N_Vector YP, N_Vector R, SUNMatrix J, void *user, N_Vector a, N_Vector b, N_Vector c) {
  (void)t, (void)YP, (void)R, (void)user, (void)a, (void)b, (void)c;
  const double *angle = V(Y), *speed = angle + m, *torque = speed + m;
  sunindextype *start = SM_INDEXPTRS_S(J), *row = SM_INDEXVALS_S(J), z = 0;
  double *value = SM_DATA_S(J), slope;
#define ENTRY(at, number) (row[z] = (at), value[z++] = (number))
  for (int i = 0; i < m; i++) {
    start[i] = z;
    ENTRY(i, cj);
    if (implicit) {
      if (i > 0) ENTRY(2 * m + i - 1, 1);
      if (i < m - 1) ENTRY(2 * m + i, -1);
    } else {
      double left = stiffness_at(angle, i - 1), right = stiffness_at(angle, i);
      if (i > 0) ENTRY(m + i - 1, -left);
      ENTRY(m + i, left + right);
      if (i < m - 1) ENTRY(m + i + 1, -right);
    }
  }
  for (int i = 0; i < m; i++) {
    double left = i > 0 ? damping[i - 1] : 0, right = i < m - 1 ? damping[i] : 0;
    friction(speed[i], &slope);
    start[m + i] = z;
    ENTRY(i, -1);
    if (i > 0) ENTRY(m + i - 1, -left);
    ENTRY(m + i, cj * inertia[i] + left + right + slope + (i == m - 1 ? BRAKE : 0));
    if (i < m - 1) ENTRY(m + i + 1, -right);
  }
  if (implicit)
    for (int i = 0; i < m - 1; i++) {
      start[2 * m + i] = z;
      ENTRY(m + i, -1);
      ENTRY(m + i + 1, 1);
      ENTRY(2 * m + i, -1 / stiffness[i] - 3 * CUBIC_TORQUE * torque[i] * torque[i]);
    }
  start[2 * m + (implicit ? m - 1 : 0)] = z;
  return 0;
}

int main(int count, char **words) {
  if (count < 4) return 1;
  int cells = atoi(words[1]);
  double rtol = atof(words[2]), section = PI * pow(0.032, 4) / 32, length = 1.0 / cells;
  implicit = atoi(words[3]);
  m = cells + 2;
  inertia = numbers(m), stiffness = numbers(m), damping = numbers(m);
  for (int i = 0; i < m; i++) inertia[i] = i == 0 || i == m - 1 ? 5e-3 : 7850 * section * length;
  for (int i = 0; i < m - 1; i++) {
    stiffness[i] = (i == 0 || i == m - 2 ? 2 : 1) * 80e9 * section / length;
    damping[i] = 2e-5 * stiffness[i];
  }
  int n = 2 * m + (implicit ? m - 1 : 0);
  SUNContext context;
  CHECK(SUNContext_Create(SUN_COMM_NULL, &context));
  N_Vector y = vector(n, context), yp = vector(n, context), differential = vector(n, context);
  for (int i = 0; i < 2 * m; i++) V(differential)[i] = 1;
  V(yp)[m] = TORQUE / inertia[0];
  void *ida = IDACreate(context);
  CHECK(IDAInit(ida, residual, 0, y, yp));
  CHECK(IDASStolerances(ida, rtol, 1e-2 * rtol));
  CHECK(IDASetId(ida, differential));
  if (implicit) CHECK(IDASetSuppressAlg(ida, 1));
  SUNMatrix matrix = SUNSparseMatrix(n, n, 12 * m, CSC_MAT, context);
  SUNLinearSolver solver = SUNLinSol_KLU(y, matrix, context);
  CHECK(SUNLinSol_KLUSetOrdering(solver, implicit ? COLAMD : NATURAL));
  CHECK(IDASetLinearSolver(ida, solver, matrix));
  CHECK(IDASetJacFn(ida, jacobian));
  CHECK(IDASetMaxNumSteps(ida, 100000000));
  CHECK(IDASetStopTime(ida, 1.0));
  static Sample samples[100];
  long steps = 0;
  double t = 0, begin = cpu();
  const double *now = V(y);
  for (int k = 1; k <= 100; k++) {
    CHECK(IDASolve(ida, 0.01 * k, &t, y, yp, IDA_NORMAL));
    samples[k - 1] = (Sample){t, now[m], now[2 * m - 1], now[0] - now[m - 1]};
  }
  double end = cpu();
  CHECK(IDAGetNumSteps(ida, &steps));
  print_run(end - begin, steps);
  print_samples(samples, 100);
  return 0;
}
