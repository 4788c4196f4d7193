#include "service/render/cost_model.h"

#include <algorithm>
#include <tuple>

namespace lumulus::service {

void CostModel::Recent::add(double figure) {
    last_.at(count_++ % last_.size()) = figure;
    std::array<double, std::tuple_size_v<decltype(last_)>> sorted = last_;
    auto* const end = sorted.begin() + std::min(count_, sorted.size());
    auto* const middle = sorted.begin() + (end - sorted.begin()) / 2;
    std::nth_element(sorted.begin(), middle, end);
    median_ = std::max(*middle, 0.5 * figure);
}

void CostModel::traced(double milliseconds) {
    trace_.add(milliseconds);
}

void CostModel::lit(double milliseconds, double share) {
    if (share > 0.0) sun_.add(milliseconds / share);
}

int CostModel::sunReductionFor(double milliseconds) const {
    for (const int reduction : sunReductions)
        if (sunMs(sunShare(reduction)) <= milliseconds) return reduction;
    return sunReductions.back();
}

CostModel::Work CostModel::reduced(Work work, int reduction, std::uint64_t pixels) {
    if (reduction == 1) return work;
    work.rays = pixels / static_cast<std::uint64_t>(reduction * reduction);
    work.enlarged = pixels;
    work.lights = work.lightsReduced.value_or(work.lights);
    return work;
}

void CostModel::drawn(const Work& work, const Spent& spent) {
    const auto each = [](double milliseconds, std::uint64_t count) {
        return std::max(0.0, milliseconds) / static_cast<double>(std::max<std::uint64_t>(1, count));
    };
    Figures& figures = work.enlarged > 0 ? reduced_ : whole_;
    if (work.lights > 0) figures.light.add(each(spent.light, work.lights));
    if (work.enlarged > 0) enlarging_.add(each(spent.enlarging, work.enlarged));
    ray_.add(each(spent.rays, work.rays));
    figures.view.add(each(spent.total - spent.light - spent.rays - spent.enlarging, work.views));
}

void CostModel::encoded(Encoding encoding, double milliseconds, std::uint64_t pixels) {
    encode_.at(static_cast<std::size_t>(encoding))
        .add(milliseconds / static_cast<double>(std::max<std::uint64_t>(1, pixels)));
}

double CostModel::drawMs(const Work& work) const {
    const auto figure = [&](Recent Figures::*part) {
        const Recent& reduced = reduced_.*part;
        return work.enlarged > 0 && reduced.isKnown() ? reduced.value() : (whole_.*part).value();
    };
    return figure(&Figures::view) * static_cast<double>(work.views) +
           figure(&Figures::light) * static_cast<double>(work.lights) + ray_.value() * static_cast<double>(work.rays) +
           enlarging_.value() * static_cast<double>(work.enlarged);
}

double CostModel::encodeMs(Encoding encoding, std::uint64_t pixels) const {
    return encode_.at(static_cast<std::size_t>(encoding)).value() * static_cast<double>(pixels);
}

int CostModel::reductionFor(double milliseconds, const Work& work, std::uint64_t pixels, Encoding encoding) const {
    const double left = milliseconds - encodeMs(encoding, pixels);  // the picture is sent at its full size
    for (const int reduction : reductions)
        if (drawMs(reduced(work, reduction, pixels)) <= left) return reduction;
    return reductions.back();
}

}  // namespace lumulus::service
