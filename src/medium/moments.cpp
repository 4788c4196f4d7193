#include "medium/moments.h"

#include <cassert>
#include <cmath>
#include <cstddef>

namespace lumulus::phase {

std::vector<double> hgMoments(double g, int count) {
    std::vector<double> moments(static_cast<std::size_t>(count));
    double power = 1.0;
    for (double& moment : moments) {
        moment = power;
        power *= g;
    }
    return moments;
}

std::vector<double> draineMoments(double g, double alpha, int count) {
    const std::vector<double> hg = hgMoments(g, count + 2);
    std::vector<double> moments(static_cast<std::size_t>(count));
    const double norm = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
    for (std::size_t i = 0; i < moments.size(); ++i) {
        const double l = static_cast<double>(i);
        const double above = (l + 1.0) * (l + 2.0) / ((2.0 * l + 1.0) * (2.0 * l + 3.0));
        double same = (l + 1.0) * (l + 1.0) / ((2.0 * l + 1.0) * (2.0 * l + 3.0));
        double below = 0.0;
        if (i >= 1) {
            same += l * l / ((2.0 * l + 1.0) * (2.0 * l - 1.0));
        }
        if (i >= 2) {
            below = l * (l - 1.0) / ((2.0 * l + 1.0) * (2.0 * l - 1.0)) * hg[i - 2];
        }
        moments[i] = (hg[i] + alpha * (above * hg[i + 2] + same * hg[i] + below)) / norm;
    }
    return moments;
}

std::vector<double> schlickMoments(double k, int count) {
    assert(std::abs(k) < 1.0);
    const double a = std::abs(k);
    // Q_l is the minimal solution of its recurrence and falls by a constant factor a step: the ratios q_l = Q_l / (k
    // Q_l−1) are stable downwards, and the error of a wrong start falls by the square of that factor a step
    const double decay = std::acosh(1.0 / a);
    const auto runUp = static_cast<std::size_t>(8.0 + 20.0 / decay);
    std::vector<double> ratio(static_cast<std::size_t>(count) + runUp);
    double next = 0.5;
    for (std::size_t i = ratio.size(); i-- > 1;) {
        const double l = static_cast<double>(i);
        next = l / ((2.0 * l + 1.0) - (l + 1.0) * a * a * next);
        ratio[i] = next;
    }
    std::vector<double> moments(static_cast<std::size_t>(count));
    moments[0] = 1.0;
    double q = std::atanh(a);
    double sign = 1.0;
    for (std::size_t l = 1; l < moments.size(); ++l) {
        sign = k < 0.0 ? -sign : sign;
        moments[l] = sign * static_cast<double>(l) * q * (1.0 - ratio[l]);
        q *= a * ratio[l];
    }
    return moments;
}

std::vector<double> powerLobeMoments(int n, int count) {
    std::vector<double> moments(static_cast<std::size_t>(count), 0.0);
    moments[0] = 1.0;
    for (int l = 1; l < count && l <= n; ++l) {
        const auto i = static_cast<std::size_t>(l);
        moments[i] = moments[i - 1] * (n - l + 1) / (n + l + 1);
    }
    return moments;
}

}  // namespace lumulus::phase
