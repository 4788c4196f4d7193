#include "light/fog_change/fog_change.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "light/fog_change/change_starts.h"

namespace lumulus::fog_change {

namespace {

constexpr std::uint64_t blockSize = 512, blocksAtATime = 32;
constexpr int layerCount = 20;
constexpr double widthOverBox = 1.5;
/// Points at which a picture has what is seen of the change, and steps between two of them along a ray.
constexpr int columns = 65, depths = 40, steps = 2;

/// Ends of layers by equal shares of height, of optical depth and of the clouds' heights.
std::vector<double> heightsFor(const fog_light::FogLight& fog, const CloudGrid& clouds) {
    constexpr int slices = 4000;
    const double bottom = fog.bottom(), slice = (fog.top() - bottom) / slices;
    const double size = clouds.upper().y - clouds.lower().y;
    const double low = clouds.lower().y - 0.25 * size, high = clouds.upper().y + 0.25 * size;
    std::vector<double> depth, inCloud;
    double wholeDepth = 0.0, wholeCloud = 0.0;
    for (int i = 0; i < slices; ++i) {
        const double from = bottom + i * slice, to = from + slice;
        double sum = 0.0;
        for (const fog_light::FogLayer& layer : fog.layers())
            sum += (layer.scattering.y + layer.absorption.y) * layer.column(from, to);
        depth.push_back(sum);
        inCloud.push_back(std::max(0.0, std::min(to, high) - std::max(from, low)));
        wholeDepth += sum;
        wholeCloud += inCloud.back();
    }
    std::vector<double> heights{bottom};
    double shares = 0.0;
    const double terms = 1.0 + (wholeDepth > 0.0 ? 1.0 : 0.0) + (wholeCloud > 0.0 ? 1.0 : 0.0);
    for (int i = 0; i < slices; ++i) {
        const auto at = static_cast<std::size_t>(i);
        double share = 1.0 / slices;
        if (wholeDepth > 0.0) share += depth[at] / wholeDepth;
        if (wholeCloud > 0.0) share += inCloud[at] / wholeCloud;
        shares += share / terms;
        if (shares * layerCount >= static_cast<double>(heights.size()) && i + 1 < slices)
            heights.push_back(bottom + (i + 1) * slice);
    }
    heights.push_back(fog.top());
    return heights;
}

ChangeCells cellsFor(const ChangeSources& sources) {
    const CloudGrid& clouds = sources.clouds;
    const glm::dvec3 middle = 0.5 * (clouds.lower() + clouds.upper()), half = 0.5 * (clouds.upper() - clouds.lower());
    return {{middle.x, middle.z}, widthOverBox * std::max({half.x, half.z, 1e-3}), heightsFor(sources.fog.fog, clouds)};
}

}  // namespace

FogChange::FogChange(const ChangeSources& sources, const Check& check)
    : toSun_(sources.toSun), paths_(sources.fog.fog.layers()), cells_(cellsFor(sources)) {
    const fog_light::FogSetting& setting = sources.fog.fog.setting();
    const PairWorld world{sources.clouds, sources.medium, paths_, cells_, setting.groundHeight, setting.groundAlbedo};
    const ChangeStarts starts(sources);
    std::vector<std::vector<Passing>> passing(blocksAtATime);
    for (std::uint64_t first = 0; first < starts.count(); first += blockSize * blocksAtATime) {
        tbb::parallel_for(std::uint64_t{0}, blocksAtATime, [&](std::uint64_t block) {
            check();
            passing[block].clear();
            PairWalk walk(world, passing[block]);
            const std::uint64_t begin = first + block * blockSize;
            for (std::uint64_t i = begin; i < std::min(begin + blockSize, starts.count()); ++i) starts.follow(i, walk);
        });
        for (const auto& block : passing) cells_.add(block);
    }
    cells_.finish(1.0);
}

FogChange::Scattered FogChange::scatteredAt(const glm::dvec3& point, const glm::dvec3& direction,
                                            const std::array<float, coefficientCount>& harmonics) const {
    const Travelling light = cells_.at(point, harmonics);
    Scattered made;
    const double cosine = -glm::dot(direction, toSun_);
    for (const WalkedLayer& walked : paths_.layers()) {
        const double density = walked.layer.density(point.y);
        if (density == 0.0) continue;
        const CutPhase& phase = walked.phase;
        glm::dvec3 turned = phase.value(cosine) * glm::dvec3(light.beam);
        for (std::size_t l = 0; l < light.bands.size(); ++l) turned += phase.moments()[l] * glm::dvec3(light.bands[l]);
        made.turned += density * walked.scattering * turned;
        made.once += density * walked.scattering * phase.value(cosine) * glm::dvec3(light.straight);
    }
    return made;
}

FogChange::Scattered FogChange::scatteredAt(const glm::dvec3& point, const glm::dvec3& direction) const {
    return scatteredAt(point, direction, harmonicsOf(glm::vec3(direction)));
}

/// Fills the depths of a column.
void FogChange::seeRay(const Ray& ray, ChangeSeen& seen, std::size_t place) const {
    const auto harmonics = harmonicsOf(glm::vec3(-ray.direction));
    const auto plane = static_cast<std::size_t>(seen.size.x) * static_cast<std::size_t>(seen.size.y);
    const auto distanceAt = [&](int depth, int step) {
        const double t = (depth + static_cast<double>(step) / steps) / (depths - 1.0);
        return seen.near + (seen.far - seen.near) * t * t;
    };
    glm::dvec3 sum(0.0);
    for (int depth = 0; depth + 1 < depths; ++depth) {
        for (int step = 0; step < steps; ++step) {
            const double from = distanceAt(depth, step), to = distanceAt(depth, step + 1), middle = 0.5 * (from + to);
            const Scattered light = scatteredAt(ray.origin + middle * ray.direction, -ray.direction, harmonics);
            if (light.turned == glm::dvec3(0.0)) continue;
            const double height = ray.origin.y, rise = ray.direction.y;
            const glm::dvec3 straight = glm::exp(-paths_.peakDepth(height, rise, middle));
            // what nothing has scattered before or after is no part of it
            sum += (to - from) * (light.turned - straight * light.once) * glm::exp(-paths_.depth(height, rise, middle));
        }
        seen.light[static_cast<std::size_t>(depth + 1) * plane + place] = glm::vec4(glm::vec3(sum), 0.0F);
    }
}

ChangeSeen FogChange::seenBy(const Camera& camera, const Check& check) const {
    ChangeSeen seen;
    const double aspect = static_cast<double>(camera.height) / camera.width;
    seen.size = {columns, std::clamp(static_cast<int>(std::lround((columns - 1) * aspect)), 1, 4 * columns) + 1,
                 depths};
    const double wide = cells_.halfWidth(ChangeCells::levels - 1);
    const glm::dvec3 lower(cells_.middle().x - wide, cells_.bottom(), cells_.middle().y - wide);
    const glm::dvec3 upper(cells_.middle().x + wide, cells_.top(), cells_.middle().y + wide);
    if (camera.projection != scene::Projection::orthographic)
        seen.near = glm::length(camera.position - glm::clamp(camera.position, lower, upper));
    seen.far = glm::length(glm::max(glm::abs(camera.position - lower), glm::abs(camera.position - upper)));
    seen.light.resize(static_cast<std::size_t>(seen.size.x) * static_cast<std::size_t>(seen.size.y) * depths,
                      glm::vec4(0.0F));
    tbb::parallel_for(0, seen.size.y, [&](int y) {
        check();
        for (int x = 0; x < seen.size.x; ++x) {
            const Ray ray = camera.ray(camera.width * static_cast<double>(x) / (seen.size.x - 1),
                                       camera.height * static_cast<double>(y) / (seen.size.y - 1));
            seeRay(ray, seen,
                   static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.size.x) + static_cast<std::size_t>(x));
        }
    });
    return seen;
}

}  // namespace lumulus::fog_change
