/* The residual of the distributed screw in tests/models/screw.hyde, written by hand. It reads the state from its standard
   input, then runs a batch of evaluations for every line and answers with the nanoseconds it took; at the end of input it
   prints the residual. Rows have the order of the unknowns: position and speed of the table, then angle and speed of every
   node of the screw. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

struct screw { int n; double rho_ip, g_ip, tv, rdx, lead, k, c, table, near, far, torque; };

__attribute__((noipa)) static void residual(const struct screw *p, const double *restrict y, const double *restrict yp,
                                            double *restrict q, double *restrict out)
{
    const int n = p->n, nut = n / 2;
    const double *th = y + 2, *w = th + n + 1, *dth = yp + 2, *dw = dth + n + 1;
    double *row_th = out + 2, *row_w = row_th + n + 1;
    const double m0 = 10.0 / 12.0 * p->rho_ip, m1 = 1.0 / 12.0 * p->rho_ip, rdx = p->rdx;
    for (int i = 0; i < n; i++)
        q[i] = p->g_ip * rdx * (th[i + 1] - th[i] + p->tv * (w[i + 1] - w[i]));
    for (int i = 0; i <= n; i++)
        row_th[i] = w[i] - dth[i];
    for (int i = 1; i < n; i++)
        row_w[i] = m1 * (dw[i - 1] + dw[i + 1]) + m0 * dw[i] - (q[i] - q[i - 1]) * rdx;
    const double force = p->k * (p->lead * th[nut] - y[0]) + p->c * (p->lead * w[nut] - y[1]);
    row_w[nut] += p->lead * force * rdx;
    row_w[0] = p->near * dw[0] - p->torque - q[0] + (m0 * dw[0] + 2 * m1 * dw[1]) / (2 * rdx);
    row_w[n] = p->far * dw[n] + q[n - 1] + (m0 * dw[n] + 2 * m1 * dw[n - 1]) / (2 * rdx);
    out[0] = y[1] - yp[0];
    out[1] = p->table * yp[1] - force;
}

int main(void)
{
    struct screw p;
    int turns;
    if (scanf("%d %d %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &p.n, &turns, &p.rho_ip, &p.g_ip, &p.tv, &p.rdx, &p.lead,
              &p.k, &p.c, &p.table, &p.near, &p.far, &p.torque) != 13)
        return 1;
    const int size = 2 * p.n + 4;
    double *y = malloc(size * sizeof *y), *yp = malloc(size * sizeof *yp), *out = malloc(size * sizeof *out);
    double *q = malloc(p.n * sizeof *q);
    for (int i = 0; i < size; i++)
        if (scanf("%lf %lf", y + i, yp + i) != 2)
            return 1;
    while (getchar() != '\n') {}
    while (getchar() == '\n') {
        struct timespec a, b;
        clock_gettime(CLOCK_MONOTONIC, &a);
        for (int turn = 0; turn < turns; turn++)
            residual(&p, y, yp, q, out);
        clock_gettime(CLOCK_MONOTONIC, &b);
        printf("%.0f\n", (b.tv_sec - a.tv_sec) * 1e9 + (b.tv_nsec - a.tv_nsec));
        fflush(stdout);
    }
    for (int i = 0; i < size; i++)
        printf("%.17g\n", out[i]);
    return 0;
}
