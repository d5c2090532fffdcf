# 50-digit values of the chi-square law, printed as shortest round-trip doubles:
#   python3 make_chi_square.py > chi_square.csv    (python3-mpmath)
# survival: probability that a variable of dof degrees of freedom exceeds chi2.
# threshold: the chi2 that is exceeded with the probability in the column "survival".
import mpmath as mp

mp.mp.dps = 50
DOFS = [1, 2, 3, 4, 5, 6, 7, 10, 11, 30, 101, 222, 1000, 1001, 20000]


def survival(x, dof):
    return mp.gammainc(mp.mpf(dof) / 2, mp.mpf(x) / 2, mp.inf, regularized=True)


def threshold(p, dof):
    # Bisection in log survival: safe for every dof, and exact to 45 digits.
    low, high = mp.mpf(0), mp.mpf(dof) + 10
    while survival(high, dof) > p:
        high *= 2
    for _ in range(170):
        middle = (low + high) / 2
        low, high = (middle, high) if survival(middle, dof) > p else (low, middle)
    return (low + high) / 2


print("what,dof,chi2,survival")
for dof in DOFS:
    sd = float(mp.sqrt(2 * dof))
    chi2s = [1e-6, 0.1, 1.0, 2.5] if dof <= 30 else []
    chi2s += [dof + k * sd for k in (-5.0, -3.0, -1.0, -0.25, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)]
    for x in chi2s:
        if x > 0:
            print(f"survival,{dof},{x!r},{float(survival(x, dof))!r}")
    for p in (0.999, 0.95, 0.5, 0.1, 0.05, 1e-2, 1e-3, 1e-4, 1e-8, 1e-14):
        print(f"threshold,{dof},{float(threshold(mp.mpf(p), dof))!r},{p!r}")
