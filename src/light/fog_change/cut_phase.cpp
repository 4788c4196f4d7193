#include "light/fog_change/cut_phase.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace lumulus::fog_change {

namespace {

constexpr int angles = 4096;
constexpr int shares = 2048;

/// Adds a panel of light about a cosine to moments.
void addMoments(std::array<double, bandCount>& moments, double cosine, double light) {
    double before = 1.0, now = cosine;
    moments[0] += light;
    moments[1] += light * cosine;
    for (std::size_t l = 2; l < moments.size(); ++l) {
        const auto n = static_cast<double>(l);
        const double next = ((2.0 * n - 1.0) * cosine * now - (n - 1.0) * before) / n;
        moments[l] += light * next;
        before = now;
        now = next;
    }
}

}  // namespace

CutPhase::CutPhase(const std::function<double(double)>& phase, double cut) {
    const double most = phase(std::cos(cut));
    std::vector<double> edges, sums{0.0};
    double peak = 0.0, peakCosines = 0.0;
    for (int i = 0; i <= angles; ++i) {
        const double t = static_cast<double>(i) / angles;
        edges.push_back(std::cos(std::numbers::pi * t * t));  // fine where the peak is
    }
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const double width = edges[i] - edges[i + 1], middle = 0.5 * (edges[i] + edges[i + 1]);
        const double value = phase(middle), left = middle > std::cos(cut) ? std::min(value, most) : value;
        peak += (value - left) * width;
        peakCosines += (value - left) * width * middle;
        sums.push_back(sums.back() + left * width);
        addMoments(moments_, middle, left * width);
    }
    for (const double edge : edges)
        values_.push_back((edge > std::cos(cut) ? std::min(phase(edge), most) : phase(edge)) /
                          (2.0 * std::numbers::pi * sums.back()));
    peak_ = peak / (peak + sums.back());
    if (peak > 0.0) peakCosine_ = peakCosines / peak;
    for (double& moment : moments_) moment /= sums.back();
    std::size_t panel = 0;
    for (int i = 0; i <= shares; ++i) {
        const double wanted = sums.back() * i / shares;
        while (panel + 2 < sums.size() && sums[panel + 1] < wanted) ++panel;
        const double width = sums[panel + 1] - sums[panel];
        const double within = width > 0.0 ? std::clamp((wanted - sums[panel]) / width, 0.0, 1.0) : 0.0;
        cosines_.push_back(edges[panel] + within * (edges[panel + 1] - edges[panel]));
    }
}

double CutPhase::value(double cosine) const {
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    const double place = std::sqrt(angle / std::numbers::pi) * angles;
    const auto first = std::min(static_cast<std::size_t>(place), values_.size() - 2);
    return values_[first] + (place - static_cast<double>(first)) * (values_[first + 1] - values_[first]);
}

double CutPhase::sampleCosine(double u) const {
    const double place = std::clamp(u, 0.0, 1.0) * shares;
    const auto first = std::min(static_cast<std::size_t>(place), cosines_.size() - 2);
    return cosines_[first] + (place - static_cast<double>(first)) * (cosines_[first + 1] - cosines_[first]);
}

}  // namespace lumulus::fog_change
