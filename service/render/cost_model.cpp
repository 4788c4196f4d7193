#include "service/render/cost_model.h"

#include <algorithm>

namespace lumulus::service {

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

void CostModel::drawn(double fixed, double total, std::uint64_t rays) {
    fixed_.add(std::min(fixed, total));
    perRay_.add(std::max(0.0, total - fixed) / static_cast<double>(std::max<std::uint64_t>(1, rays)));
}

void CostModel::encoded(Encoding encoding, double milliseconds, std::uint64_t pixels) {
    encode_.at(static_cast<std::size_t>(encoding))
        .add(milliseconds / static_cast<double>(std::max<std::uint64_t>(1, pixels)));
}

double CostModel::drawMs(std::uint64_t views, std::uint64_t rays) const {
    return fixed_.value * static_cast<double>(views) + perRay_.value * static_cast<double>(rays);
}

double CostModel::encodeMs(Encoding encoding, std::uint64_t pixels) const {
    return encode_.at(static_cast<std::size_t>(encoding)).value * static_cast<double>(pixels);
}

int CostModel::reductionFor(double milliseconds, std::uint64_t views, std::uint64_t rays, std::uint64_t pixels,
                            Encoding encoding) const {
    const double left = milliseconds - encodeMs(encoding, pixels);  // the picture is sent at its full size
    for (const int reduction : reductions) {
        const auto area = static_cast<std::uint64_t>(reduction * reduction);
        if (drawMs(views, reduction == 1 ? rays : pixels / area) <= left) return reduction;
    }
    return reductions.back();
}

}  // namespace lumulus::service
