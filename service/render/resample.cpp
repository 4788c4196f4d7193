#include "service/render/resample.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace lumulus::service {
namespace {

/// Between which two pixels of a line a place lies, and where.
struct Between {
    int first = 0, second = 0;
    float share = 0.0F;  // of the second
};

/// For each of `wanted` pixels from `from` of a side of `whole`, the pixels of a side of `small`, counted from `origin`
/// and `count` long.
std::vector<Between> places(int from, int wanted, int whole, int small, int origin, int count, bool nearest) {
    std::vector<Between> result;
    for (int i = 0; i < wanted; ++i) {
        const double place = (from + i + 0.5) * small / whole - origin - 0.5;
        const double low = nearest ? std::round(place) : std::floor(place);
        const int last = count - 1;
        result.push_back({std::clamp(static_cast<int>(low), 0, last),
                          std::clamp(static_cast<int>(low) + (nearest ? 0 : 1), 0, last),
                          nearest ? 0.0F : static_cast<float>(place - low)});
    }
    return result;
}

/// As std::lerp, which takes four times as long to be exact at the ends and beyond.
float between(float first, float second, float share) {
    return first + share * (second - first);
}

}  // namespace

View reducedView(const View& view, int reduction) {
    View reduced = view;
    reduced.mostRays = 1;
    reduced.coarse = true;
    reduced.image.width = (view.image.width + reduction - 1) / reduction;
    reduced.image.height = (view.image.height + reduction - 1) / reduction;
    if (view.tile) {
        const auto scale = [](int at, int whole, int small, bool up) {
            const double place = static_cast<double>(at) * small / whole;
            return static_cast<int>(up ? std::ceil(place) : std::floor(place));
        };
        const Tile& t = *view.tile;
        const int x = scale(t.x, view.image.width, reduced.image.width, false);
        const int y = scale(t.y, view.image.height, reduced.image.height, false);
        reduced.tile = Tile{x, y, scale(t.x + t.width, view.image.width, reduced.image.width, true) - x,
                            scale(t.y + t.height, view.image.height, reduced.image.height, true) - y};
    }
    return reduced;
}

LayeredImage enlarged(const LayeredImage& image, const View& view, const View& reduced) {
    const Tile to = drawnTile(view), from = drawnTile(reduced);
    const auto along = [&](bool nearest) {
        return std::pair(
            places(to.x, to.width, view.image.width, reduced.image.width, from.x, from.width, nearest),
            places(to.y, to.height, view.image.height, reduced.image.height, from.y, from.height, nearest));
    };
    const auto mixed = along(false), nearest = along(true);
    LayeredImage result;
    result.width = to.width;
    result.height = to.height;
    result.attributes = image.attributes;
    const auto across = static_cast<std::size_t>(image.width);
    std::vector<float> line(across);
    for (const auto& [name, values] : image.layers) {
        const auto& [columns, rows] = name.starts_with("depth.") ? nearest : mixed;
        float* out = result.layer(name).data();
        for (const Between& row : rows) {
            const float* upper = values.data() + static_cast<std::size_t>(row.first) * across;
            const float* lower = values.data() + static_cast<std::size_t>(row.second) * across;
            for (std::size_t x = 0; x < across; ++x) line[x] = between(upper[x], lower[x], row.share);
            for (const Between& column : columns)
                *out++ = between(line[static_cast<std::size_t>(column.first)],
                                 line[static_cast<std::size_t>(column.second)], column.share);
        }
    }
    return result;
}

}  // namespace lumulus::service
