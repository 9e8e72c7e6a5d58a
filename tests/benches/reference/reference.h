/* What the reference programs share: the clock, vectors whose operations are vectorised, and the lines that they print.
 *
 * A program solves one problem and prints, after the clock has stopped:
 *   cpu SECONDS        user and system time of the solve, without set-up and output
 *   steps N            steps of IDA
 *   sample T A B C     states at T, as the problem says
 *   event T            in order
 * Build one by hand, with IDA and KLU installed:
 *   cc -O3 -march=native shaft.c -lsundials_ida -lsundials_nvecserial -lsundials_sunmatrixsparse \
 *      -lsundials_sunmatrixdense -lsundials_sunlinsolklu -lsundials_sunlinsoldense -lsundials_core -lklu -lm */
#ifndef REFERENCE_H
#define REFERENCE_H
#include <ida/ida.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PI 3.14159265358979323846
/* Below this length a plain loop is quicker than vector instructions. */
enum { SHORT = 16 };
/* Components of a vector. Two vectors of a loop are the same one or do not overlap. */
#define V(x) (NV_DATA_S(x))
#define OVER(n) _Pragma("GCC ivdep") for (long i = 0; i < (n); i++)

#define CHECK(call)                                              \
  do {                                                           \
    int code_ = (call);                                          \
    if (code_ < 0) {                                             \
      fprintf(stderr, "%s returned %d\n", #call, code_);         \
      exit(2);                                                   \
    }                                                            \
  } while (0)

static inline double cpu(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline double *numbers(long count) {
  double *all = calloc((size_t)count, sizeof *all);
  if (!all) exit(3);
  return all;
}

/* ---- Vectors ---- */

static void linear_sum(double a, N_Vector X, double b, N_Vector Y, N_Vector Z) {
  const double *x = V(X), *y = V(Y);
  double *z = V(Z);
  long n = NV_LENGTH_S(X);
  if (a == 1.0 && b == 1.0)
    OVER(n) z[i] = x[i] + y[i];
  else if (a == 1.0)
    OVER(n) z[i] = x[i] + b * y[i];
  else if (b == 1.0)
    OVER(n) z[i] = a * x[i] + y[i];
  else
    OVER(n) z[i] = a * x[i] + b * y[i];
}

static void constant(double c, N_Vector Z) {
  double *z = V(Z);
  OVER(NV_LENGTH_S(Z)) z[i] = c;
}

static void scaled(double c, N_Vector X, N_Vector Z) {
  const double *x = V(X);
  double *z = V(Z);
  if (c == 1.0)
    memmove(z, x, (size_t)NV_LENGTH_S(X) * sizeof *z);
  else
    OVER(NV_LENGTH_S(X)) z[i] = c * x[i];
}

static void magnitude(N_Vector X, N_Vector Z) {
  const double *x = V(X);
  double *z = V(Z);
  OVER(NV_LENGTH_S(X)) z[i] = fabs(x[i]);
}

static void inverse(N_Vector X, N_Vector Z) {
  const double *x = V(X);
  double *z = V(Z);
  OVER(NV_LENGTH_S(X)) z[i] = 1.0 / x[i];
}

static void plus_constant(N_Vector X, double b, N_Vector Z) {
  const double *x = V(X);
  double *z = V(Z);
  OVER(NV_LENGTH_S(X)) z[i] = x[i] + b;
}

__attribute__((optimize("no-tree-vectorize"))) static double short_norm(long n, const double *x, const double *w) {
  double sum = 0;
  for (long i = 0; i < n; i++) sum += x[i] * w[i] * (x[i] * w[i]);
  return sqrt(sum / (double)n);
}

static double weighted_norm(N_Vector X, N_Vector W) {
  const double *x = V(X), *w = V(W);
  if (NV_LENGTH_S(X) < SHORT) return short_norm(NV_LENGTH_S(X), x, w);
  long n = NV_LENGTH_S(X), whole = n & ~7L;
  double sums[8] = {0};
  for (long i = 0; i < whole; i += 8)
    for (int k = 0; k < 8; k++) {
      double part = x[i + k] * w[i + k];
      sums[k] += part * part;
    }
  double sum = 0;
  for (long i = whole; i < n; i++) sum += x[i] * w[i] * (x[i] * w[i]);
  for (int k = 0; k < 8; k++) sum += sums[k];
  return sqrt(sum / (double)n);
}

__attribute__((optimize("no-tree-vectorize"))) static int short_combination(int count, const double *c, N_Vector *X, N_Vector Z) {
  double *z = V(Z), sum[SHORT];
  long n = NV_LENGTH_S(Z);
  const double *x = V(X[0]);
  for (long i = 0; i < n; i++) sum[i] = c[0] * x[i];
  for (int j = 1; j < count; j++) {
    x = V(X[j]);
    for (long i = 0; i < n; i++) sum[i] += c[j] * x[i];
  }
  for (long i = 0; i < n; i++) z[i] = sum[i];
  return 0;
}

/* The predictor: one pass over all vectors, a block at a time. */
static int combination(int count, double *c, N_Vector *X, N_Vector Z) {
  double *z = V(Z);
  long n = NV_LENGTH_S(Z);
  if (n < SHORT) return short_combination(count, c, X, Z);
  enum { BLOCK = 256 };
  double sum[BLOCK];
  for (long from = 0; from < n; from += BLOCK) {
    long size = n - from < BLOCK ? n - from : BLOCK;
    const double *first = V(X[0]) + from;
    OVER(size) sum[i] = c[0] * first[i];
    for (int j = 1; j < count; j++) {
      const double *x = V(X[j]) + from;
      double factor = c[j];
      OVER(size) sum[i] += factor * x[i];
    }
    memcpy(z + from, sum, (size_t)size * sizeof *z);
  }
  return 0;
}

/* A vector whose clones have these operations, too. */
static inline N_Vector vector(long n, SUNContext context) {
  N_Vector made = N_VNew_Serial(n, context);
  if (!made) exit(3);
  made->ops->nvlinearsum = linear_sum;
  made->ops->nvconst = constant;
  made->ops->nvscale = scaled;
  made->ops->nvabs = magnitude;
  made->ops->nvinv = inverse;
  made->ops->nvaddconst = plus_constant;
  made->ops->nvwrmsnorm = weighted_norm;
  made->ops->nvlinearcombination = combination;
  constant(0.0, made);
  return made;
}

/* ---- What is printed ---- */

typedef struct {
  double t, a, b, c;
} Sample;

static inline void print_run(double seconds, long steps) {
  printf("cpu %.9f\nsteps %ld\n", seconds, steps);
}

static inline void print_samples(const Sample *all, int count) {
  for (int i = 0; i < count; i++) printf("sample %.17g %.17g %.17g %.17g\n", all[i].t, all[i].a, all[i].b, all[i].c);
}
#endif
