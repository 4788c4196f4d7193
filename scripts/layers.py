"""Plane-parallel layers by doubling (van de Hulst 1980, Hansen 1971): what a layer reflects and transmits, for layers
that no published table names. Henyey-Greenstein, black ground, light from above; only the azimuthal mean is needed."""

import functools
import math

STREAMS = 12  # a hemisphere; one more carries the incident beam


@functools.lru_cache(maxsize=None)
def gauss(n):
    """Nodes and weights of Gauss and Legendre on (0, 1)."""
    nodes, weights = [], []
    for i in range(n):
        x = math.cos(math.pi * (i + 0.75) / (n + 0.5))
        for _ in range(50):
            p0, p1 = 1.0, x
            for l in range(2, n + 1):
                p0, p1 = p1, ((2 * l - 1) * x * p1 - (l - 1) * p0) / l
            slope = n * (x * p1 - p0) / (x * x - 1.0)
            x -= p1 / slope
        nodes.append(0.5 * (x + 1.0))
        weights.append(1.0 / ((1.0 - x * x) * slope * slope))
    return nodes, weights


def legendre(x, count):
    values = [1.0, x]
    for l in range(2, count):
        values.append(((2 * l - 1) * x * values[-1] - (l - 1) * values[-2]) / l)
    return values


def product(a, b):
    columns = list(zip(*b))
    return [[sum(x * y for x, y in zip(row, column)) for column in columns] for row in a]


def total(a, b):
    return [[x + y for x, y in zip(p, q)] for p, q in zip(a, b)]


def inverse(matrix):
    """Of a small matrix, by Gauss and Jordan with pivots."""
    n = len(matrix)
    rows = [list(row) + [float(i == j) for j in range(n)] for i, row in enumerate(matrix)]
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        scale = 1.0 / rows[i][i]
        rows[i] = [x * scale for x in rows[i]]
        for k in range(n):
            if k != i and rows[k][i] != 0.0:
                factor = rows[k][i]
                rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i])]
    return [row[n:] for row in rows]


def thin(thickness, g, albedo, mu, weight):
    """Flux from stream j into stream i in a layer so thin that light turns once; what is not scattered or absorbed goes
    straight on. Columns are normalised, so that energy is conserved exactly at albedo 1."""
    n, terms = len(mu), 2 * STREAMS
    polynomials = [legendre(x, terms) for x in mu]
    reflect = [[0.0] * n for _ in mu]
    transmit = [[0.0] * n for _ in mu]
    for j in range(n):
        forward, backward = [0.0] * n, [0.0] * n
        for i in range(n):
            parts = [(2 * l + 1) * g**l * polynomials[i][l] * polynomials[j][l] for l in range(terms)]
            forward[i] = 0.5 * weight[i] * sum(parts)
            backward[i] = 0.5 * weight[i] * (sum(parts[0::2]) - sum(parts[1::2]))
        scale = 1.0 / (sum(forward) + sum(backward))
        turned = -math.expm1(-thickness / mu[j])
        for i in range(n):
            reflect[i][j] = albedo * turned * scale * backward[i]
            transmit[i][j] = albedo * turned * scale * forward[i] + (1.0 - turned if i == j else 0.0)
    return reflect, transmit


def layer(tau, g, albedo, mu0=1.0):
    """Fractions of the incident flux: reflected, transmitted (the direct part included), absorbed."""
    nodes, weights = gauss(STREAMS)
    mu, weight = nodes + [mu0], weights + [0.0]
    doublings = max(0, math.ceil(math.log2(tau / 2e-6)))
    reflect, transmit = thin(tau / 2**doublings, g, albedo, mu, weight)
    identity = [[float(i == j) for j in range(len(mu))] for i in range(len(mu))]
    for _ in range(doublings):
        between = inverse([[x - y for x, y in zip(p, q)] for p, q in zip(identity, product(reflect, reflect))])
        down = product(between, transmit)
        reflect = total(reflect, product(transmit, product(reflect, down)))
        transmit = product(transmit, down)
    reflected, transmitted = (sum(row[-1] for row in matrix) for matrix in (reflect, transmit))
    return {"reflected": reflected, "transmitted": transmitted, "absorbed": max(0.0, 1.0 - reflected - transmitted)}
