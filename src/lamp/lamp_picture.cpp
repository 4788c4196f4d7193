#include "lamp/lamp_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "frame/sun_cover.h"
#include "lamp/among_clouds.h"
#include "lamp/beam.h"
#include "lamp/glow.h"
#include "lamp/haze.h"
#include "lamp/lamp_tree.h"
#include "lamp/mean_miss.h"
#include "lamp/ray_bundle.h"
#include "lamp/seen_lamps.h"
#include "lamp/smooth_light.h"

namespace lumulus::lamp {

namespace {

constexpr double farAway = 1e9;  // metres
/// Edge of the blocks of pixels in which the light of far lamps is interpolated. They begin at the whole picture's
/// corner, so that a part of it has the same bits.
constexpr int block = 8;
/// Edge of the largest squares in which light is interpolated.
constexpr int area = 32;

/// Directions across the map of the shade of a lamp, and those of all maps together.
constexpr double widestMap = 192.0, narrowestMap = 16.0, allMaps = 192.0 * 192.0 * 8.0;
/// The same for solid bodies.
constexpr double widestSolidMap = 512.0, allSolidMaps = 512.0 * 512.0 * 6.0;
/// Rays across a pixel that sees clouds.
constexpr double fewestRays = 1.0, mostRays = 4.0;

/// A lamp's disc in a pixel.
struct Disc {
    float share = 0.0F;   ///< of the pixel
    float hidden = 0.0F;  ///< of what is behind
    double distance = farAway;
};

class LampPainter {
  public:
    LampPainter(const Camera& camera, const Tile& tile, const Surroundings& around, const Check& check)
        : camera_(camera),
          tile_(tile),
          ground_(around.ground),
          haze_(around.fog, camera.position),
          clouds_(around.clouds),
          solids_(around.solids) {
        for (const scene::Lamp& lamp : around.lamps)
            if (lamp.shines() && !(ground_ && lamp.position.y + lamp.radius <= ground_->height))
                beams_.emplace_back(lamp);
        discs_.resize(static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height));
        light_.resize(discs_.size(), glm::dvec3(0.0));
        if (!clouds_.empty()) castShadows(check);
        if (solids_ != nullptr) castSolidShadows(check);
        tree_.emplace(beams_);
        if (around.discs) findDiscs();
    }

    const std::vector<Beam>& beams() const { return beams_; }
    Around around() const { return {haze_, clouds_, ground_, solids_}; }
    bool scatters() const { return !haze_.isClear() || !clouds_.empty(); }

    void paint(const Check& check, const Glow* glow) {
        const int firstRow = tile_.y / area, lastRow = (tile_.y + tile_.height - 1) / area;
        const int firstColumn = tile_.x / area, lastColumn = (tile_.x + tile_.width - 1) / area;
        const int columns = lastColumn - firstColumn + 1;
        tbb::parallel_for(0, (lastRow - firstRow + 1) * columns, [&](int i) {
            paintArea(area * glm::ivec2(firstColumn + i % columns, firstRow + i / columns), check, glow);
        });
    }

    void addTo(LayeredImage& image) const {
        const std::array<float*, 3> colours{image.layer("R").data(), image.layer("G").data(), image.layer("B").data()};
        for (std::size_t i = 0; i < light_.size(); ++i) {
            const double hidden = static_cast<double>(discs_[i].hidden);
            for (std::size_t c = 0; c < 3; ++c) {
                const double before = static_cast<double>(colours[c][i]);
                colours[c][i] = static_cast<float>(before * (1.0 - hidden) + light_[i][static_cast<glm::length_t>(c)]);
            }
        }
    }

  private:
    std::size_t indexOf(const glm::ivec2& pixel) const {
        return static_cast<std::size_t>(pixel.y - tile_.y) * static_cast<std::size_t>(tile_.width) +
               static_cast<std::size_t>(pixel.x - tile_.x);
    }
    Ray rayOf(const glm::dvec2& place) const { return camera_.ray(place.x, place.y); }

    double groundOn(const Ray& ray) const {
        if (!ground_ || !(ray.direction.y < 0.0)) return farAway;
        return std::min(farAway, std::max(0.0, ray.origin.y - ground_->height) / -ray.direction.y);
    }

    /// Where a ray meets the ground or something before it.
    double endOf(const Ray& ray) const {
        const double ground = groundOn(ray);
        return solids_ != nullptr ? solids_->end(ray, ground) : ground;
    }

    /// The light of the ground where a ray sees it.
    glm::dvec3 groundOf(const LampsAlong& lamps, const Ray& ray) const {
        const double metres = groundOn(ray);
        if (!(metres < farAway) || ground_->albedo == glm::dvec3(0.0) || endOf(ray) < metres) return glm::dvec3(0.0);
        return lamps.onGround(*ground_, ray, metres);
    }

    /// The end of the ray of a pixel of the tile: a lamp's disc ends it where it covers most of the pixel.
    double endIn(const glm::ivec2& pixel, const Ray& ray) const {
        const glm::ivec2 last(tile_.x + tile_.width - 1, tile_.y + tile_.height - 1);
        const bool inside = glm::clamp(pixel, glm::ivec2(tile_.x, tile_.y), last) == pixel;
        const bool covered = inside && discs_[indexOf(pixel)].share > 0.5F;
        return std::min(endOf(ray), covered ? discs_[indexOf(pixel)].distance : farAway);
    }

    void castShadows(const Check& check) {
        const double edge = std::sqrt(allMaps / static_cast<double>(beams_.size()));
        for (Beam& beam : beams_)
            beam.shadeBy(clouds_, static_cast<int>(std::clamp(edge, narrowestMap, widestMap)), check);
        const double pixel = glm::length(rayOf(0.5 * glm::dvec2(camera_.width, camera_.height)).direction -
                                         rayOf(0.5 * glm::dvec2(camera_.width, camera_.height) + 1.0).direction);
        const double away = std::max(0.0, glm::length(clouds_.middle() - camera_.position) - clouds_.radius());
        raysAmongClouds_ =
            static_cast<int>(std::clamp(std::round(2.0 * pixel * away / clouds_.finestVoxel()), fewestRays, mostRays));
    }

    void castSolidShadows(const Check& check) {
        const double edge = std::sqrt(allSolidMaps / static_cast<double>(beams_.size()));
        for (Beam& beam : beams_)
            beam.shadeBy(*solids_, static_cast<int>(std::clamp(edge, narrowestMap, widestSolidMap)), check);
    }

    /// Whether a solid body stands before what is at a distance, in the middle of a pixel.
    bool isHidden(const glm::ivec2& pixel, double distance) const {
        return solids_ != nullptr && endOf(rayOf(glm::dvec2(pixel) + 0.5)) < distance;
    }

    void findDiscs() {
        for (const Beam& beam : beams_) {
            const glm::dvec3 way = beam.position() - camera_.position;
            const double distance = glm::length(way);
            if (distance <= beam.radius() || groundOn({camera_.position, way / distance}) < distance - beam.radius())
                continue;
            const glm::dvec3 direction = way / distance;
            const double angle = std::asin(std::min(1.0, beam.radius() / distance));
            const double clear = clouds_.depth({camera_.position, direction}, distance - beam.radius());
            const glm::dvec3 radiance = std::exp(-clear) * beam.intensity(-direction) /
                                        (std::numbers::pi * beam.radius() * beam.radius()) *
                                        glm::exp(-haze_.depth({camera_.position, direction}, distance - beam.radius()));
            for (const frame::CoveredPixel& seen : frame::sunCover(camera_, tile_, direction, angle)) {
                if (isHidden(seen.pixel, distance - beam.radius())) continue;
                Disc& disc = discs_[indexOf(seen.pixel)];
                light_[indexOf(seen.pixel)] += seen.share * radiance;
                disc.share = std::min(1.0F, disc.share + static_cast<float>(seen.share));
                disc.hidden = std::min(1.0F, disc.hidden + static_cast<float>(seen.share * std::exp(-clear)));
                disc.distance = std::min(disc.distance, distance - beam.radius());
            }
        }
    }

    /// Whether some of a pixel's corners see the ground and others do not.
    bool endsInPart(const glm::ivec2& pixel) const {
        int grounded = 0;
        for (int k = 0; k < 4; ++k) grounded += groundOn(rayOf(pixel + glm::ivec2(k % 2, k / 2))) < farAway;
        return grounded != 0 && grounded != 4;
    }

    glm::dvec3 groundIn(const LampsAlong& lamps, const glm::ivec2& pixel, int rays) const {
        glm::dvec3 sum(0.0);
        for (int i = 0; i < rays * rays; ++i) {
            const Ray ray = rayOf(glm::dvec2(pixel) + (glm::dvec2(i % rays, i / rays) + 0.5) / double(rays));
            sum += groundOf(lamps, ray);
        }
        return sum / static_cast<double>(rays * rays);
    }

    /// Light of a beam that is scattered, seen at the corners of the pixels of a block.
    struct BeamCorners {
        const Beam* beam;
        std::array<glm::dvec3, (block + 1) * (block + 1)> values;
    };

    BeamCorners cornersOf(const glm::ivec2& first, const Beam& beam) const {
        BeamCorners corners{&beam, {}};
        for (int i = 0; i < (block + 1) * (block + 1); ++i)
            corners.values[static_cast<std::size_t>(i)] =
                beamAt(beam, glm::dvec2(first + glm::ivec2(i % (block + 1), i / (block + 1))), first, 1.0);
        return corners;
    }

    glm::dvec3 beamAt(const Beam& beam, const glm::dvec2& place, const glm::ivec2& pixel, double edge) const {
        return scatteredIn(picture_, haze_, beam, place, pixel, edge);
    }

    /// The mean over a pixel: by more rays where its corners and its middle differ, at the sides of a beam.
    glm::dvec3 beamIn(const glm::ivec2& pixel, const glm::ivec2& within, const BeamCorners& corners) const {
        const auto at = static_cast<std::size_t>(within.y * (block + 1) + within.x);
        const glm::dvec3 middle = beamAt(*corners.beam, glm::dvec2(pixel) + 0.5, pixel, 1.0);
        glm::dvec3 least = middle, most = middle, sum(0.0);
        for (const std::size_t corner : {at, at + 1, at + block + 1, at + block + 2}) {
            least = glm::min(least, corners.values[corner]);
            most = glm::max(most, corners.values[corner]);
            sum += 0.25 * corners.values[corner];
        }
        if (most.x + most.y + most.z == 0.0) return middle;
        if (glm::all(glm::lessThan(most - least, 0.2 * most + 1e-300))) return (2.0 * middle + sum) / 3.0;
        constexpr int rays = 6;
        sum = glm::dvec3(0.0);
        for (int i = 0; i < rays * rays; ++i)
            sum += beamAt(*corners.beam, glm::dvec2(pixel) + (glm::dvec2(i % rays, i / rays) + 0.5) / double(rays),
                          pixel, 1.0 / rays);
        return sum / static_cast<double>(rays * rays);
    }

    /// Light that is smooth is interpolated in larger squares where these are narrow, and show fog alone.
    void paintArea(const glm::ivec2& first, const Check& check, const Glow* glow) {
        const glm::ivec2 from = glm::max(glm::ivec2(0), glm::ivec2(tile_.x, tile_.y) - first) / block;
        const glm::ivec2 last =
            glm::min(glm::ivec2(area), glm::ivec2(tile_.x + tile_.width, tile_.y + tile_.height) - first);
        const RayBundle rays = bundleOf(camera_, {first, area}, farAway);
        const bool whole = solids_ == nullptr && clouds_.empty() && rays.isNarrow();
        if (whole && !haze_.isClear())
            addSmoothLight(picture_, haze_, LampsAlong(*tree_, haze_, rays).smooth(), {first, area}, false);
        for (int y = from.y * block; y < last.y; y += block)
            for (int x = from.x * block; x < last.x; x += block) {
                check();
                paintBlock(first + glm::ivec2(x, y), !whole, glow);
            }
    }

    void paintBlock(const glm::ivec2& first, bool smoothToo, const Glow* glow) {
        double end = 0.0;
        int grounded = 0;
        for (int k = 0; k < 4; ++k) {
            const double one = endOf(rayOf(glm::dvec2(first) + 0.5 + double(block) * glm::dvec2(k % 2, k / 2)));
            end = std::max(end, one);
            grounded += one < farAway;
        }
        const bool solid = seesSolids(first), mixed = (grounded != 0 && grounded != 4) || solid;
        const RayBundle rays = bundleOf(camera_, {first, block}, mixed ? farAway : end);
        const LampsAlong lamps(*tree_, haze_, rays);
        if (seesClouds(first)) return paintAmongClouds(first, lamps, glow);
        std::vector<BeamCorners> corners;
        if (!haze_.isClear()) {
            if (smoothToo) addSmoothLight(picture_, haze_, lamps.smooth(), {first, block}, solid);
            for (const NodeLight& node : lampsInFog(lamps.others(), haze_, rays, 0.0).nodes)
                corners.push_back(cornersOf(first, *node.node->beam));
        }
        for (int i = 0; i < block * block; ++i) {
            const glm::ivec2 within(i % block, i / block), pixel = first + within;
            if (!isWanted(pixel)) continue;
            glm::dvec3& light = light_[indexOf(pixel)];
            if (glow != nullptr) light += glow->at(glm::dvec2(pixel) + 0.5, 0.0);
            if (ground_)
                light += (1.0 - static_cast<double>(discs_[indexOf(pixel)].share)) *
                         groundIn(lamps, pixel, solid || endsInPart(pixel) ? 4 : 1);
            for (const BeamCorners& beam : corners) light += beamIn(pixel, within, beam);
        }
    }

    bool isWanted(const glm::ivec2& pixel) const {
        return pixel.x >= tile_.x && pixel.y >= tile_.y && pixel.x < tile_.x + tile_.width &&
               pixel.y < tile_.y + tile_.height;
    }

    /// Whether a pixel of a block shows a solid body.
    bool seesSolids(const glm::ivec2& first) const {
        if (solids_ == nullptr) return false;
        for (int i = 0; i < block * block; ++i)
            if (solids_->distance(rayOf(glm::dvec2(first + glm::ivec2(i % block, i / block)) + 0.5), farAway))
                return true;
        return false;
    }

    /// Whether there may be clouds in a block.
    bool seesClouds(const glm::ivec2& first) const {
        if (clouds_.empty()) return false;
        std::vector<CloudPart> parts;
        constexpr int rays = block / 2;
        for (int i = 0; i < (rays + 1) * (rays + 1) && parts.empty(); ++i) {
            const Ray ray = rayOf(glm::dvec2(first) + 2.0 * glm::dvec2(i % (rays + 1), i / (rays + 1)));
            clouds_.addParts(ray, endOf(ray), parts);
        }
        return !parts.empty();
    }

    void paintAmongClouds(const glm::ivec2& first, const LampsAlong& lamps, const Glow* glow) {
        const int rays = raysAmongClouds_;
        std::vector<PassedBeam> beams;
        for (const NodeLight& node : lamps.amongClouds().nodes) beams.push_back({node.node->beam, 0.0});
        for (int i = 0; i < block * block; ++i) {
            const glm::ivec2 pixel = first + glm::ivec2(i % block, i / block);
            if (!isWanted(pixel)) continue;
            glm::dvec3 light(0.0);
            double clear = 0.0;
            for (int k = 0; k < rays * rays; ++k) {
                const glm::dvec2 place = glm::dvec2(pixel) + (glm::dvec2(k % rays, k / rays) + 0.5) / double(rays);
                const Ray ray = rayOf(place);
                for (PassedBeam& passed : beams)
                    passed.miss = meanMiss(camera_, place, 1.0 / rays, ray, passed.beam->position());
                const SeenAmongClouds seen = scatteredAmongClouds(around(), beams, ray, endIn(pixel, ray));
                light += seen.light;
                clear += seen.clear;
                const double open = 1.0 - static_cast<double>(discs_[indexOf(pixel)].share);
                if (ground_) light += open * seen.clear * groundOf(lamps, ray);
            }
            const double each = 1.0 / (rays * rays);
            light_[indexOf(pixel)] += each * light;
            if (glow != nullptr) light_[indexOf(pixel)] += glow->at(glm::dvec2(pixel) + 0.5, 1.0 - each * clear);
        }
    }

    Camera camera_;
    Tile tile_;
    std::optional<scene::Ground> ground_;
    Haze haze_;
    Clouds clouds_;
    const Solids* solids_;
    LitPicture picture_{
        camera_, farAway, [this](const Ray& ray) { return endOf(ray); },
        [this](const glm::ivec2& pixel, const Ray& ray) { return endIn(pixel, ray); },
        [this](const glm::ivec2& pixel) { return isWanted(pixel) ? &light_[indexOf(pixel)] : nullptr; }};
    int raysAmongClouds_ = 1;
    std::vector<Beam> beams_;
    std::optional<LampTree> tree_;
    std::vector<Disc> discs_;
    std::vector<glm::dvec3> light_;
};

}  // namespace

void addLamps(LayeredImage& image, const Camera& camera, const Tile& tile, const Surroundings& around,
              const Check& check) {
    LampPainter painter(camera, tile, around, check);
    if (painter.beams().empty()) return;
    std::optional<Glow> glow;
    if (around.paths > 0 && painter.scatters())
        glow.emplace(camera, painter.around(), painter.beams(),
                     Glow::Paths{static_cast<std::uint64_t>(around.paths), around.seed}, check);
    painter.paint(check, glow ? &*glow : nullptr);
    painter.addTo(image);
}

}  // namespace lumulus::lamp
