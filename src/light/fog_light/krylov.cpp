#include "light/fog_light/krylov.h"

#include <cmath>

namespace lumulus::fog_light {

namespace {

constexpr int basisSize = 60, restarts = 6;

double dot(const Vector& a, const Vector& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

void addTimes(Vector& to, double factor, const Vector& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

/// Columns of the upper triangle that Givens rotations make of the Hessenberg matrix, and what they make of the right
/// side.
struct Triangle {
    std::vector<Vector> columns;
    Vector cosines, sines, right;

    void add(Vector column) {
        const std::size_t n = columns.size();
        for (std::size_t i = 0; i < n; ++i) {
            const double upper = column[i], lower = column[i + 1];
            column[i] = cosines[i] * upper + sines[i] * lower;
            column[i + 1] = cosines[i] * lower - sines[i] * upper;
        }
        const double length = std::hypot(column[n], column[n + 1]);
        cosines.push_back(length > 0.0 ? column[n] / length : 1.0);
        sines.push_back(length > 0.0 ? column[n + 1] / length : 0.0);
        column[n] = length;
        right.push_back(-sines[n] * right[n]);
        right[n] *= cosines[n];
        columns.push_back(std::move(column));
    }
    Vector solution() const {
        Vector y(columns.size(), 0.0);
        for (std::size_t i = y.size(); i-- > 0;) {
            double value = right[i];
            for (std::size_t j = i + 1; j < y.size(); ++j) value -= columns[j][i] * y[j];
            y[i] = columns[i][i] > 0.0 ? value / columns[i][i] : 0.0;
        }
        return y;
    }
};

/// Improves x; returns the residual's length.
double improve(const std::function<Vector(const Vector&)>& k, const Vector& b, double goal, Vector& x) {
    Vector residual = k(x);
    for (std::size_t i = 0; i < b.size(); ++i) residual[i] += b[i] - x[i];
    const double length = std::sqrt(dot(residual, residual));
    if (length <= goal) return length;
    for (double& value : residual) value /= length;
    std::vector<Vector> basis{residual};
    Triangle triangle;
    triangle.right = {length};
    while (static_cast<int>(triangle.columns.size()) < basisSize && std::abs(triangle.right.back()) > goal) {
        const Vector& last = basis.back();
        Vector next = k(last);
        for (std::size_t i = 0; i < next.size(); ++i) next[i] = last[i] - next[i];
        Vector column;
        for (const Vector& v : basis) {
            column.push_back(dot(next, v));
            addTimes(next, -column.back(), v);
        }
        column.push_back(std::sqrt(dot(next, next)));
        const double norm = column.back();
        triangle.add(std::move(column));
        if (!(norm > 0.0)) break;
        for (double& value : next) value /= norm;
        basis.push_back(std::move(next));
    }
    const Vector y = triangle.solution();
    for (std::size_t i = 0; i < y.size(); ++i) addTimes(x, y[i], basis[i]);
    return std::abs(triangle.right.back());
}

}  // namespace

Vector solveFixedPoint(const std::function<Vector(const Vector&)>& k, const Vector& b, double tolerance) {
    Vector x = b;
    const double goal = tolerance * std::sqrt(dot(b, b));
    if (!(goal > 0.0)) return x;
    for (int i = 0; i < restarts; ++i)
        if (improve(k, b, goal, x) <= goal) break;
    return x;
}

}  // namespace lumulus::fog_light
