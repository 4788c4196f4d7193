#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
#include "lamp/clouds.h"
#include "lamp/depth_map.h"
#include "scene/lamp.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// What a lamp sends into each direction, and what clouds leave of it.
class Beam {
  public:
    explicit Beam(const scene::Lamp& lamp);

    const glm::dvec3& position() const { return lamp_.position; }
    double radius() const { return lamp_.radius; }
    const glm::dvec3& power() const { return lamp_.power; }
    const glm::dvec3& direction() const { return lamp_.direction; }
    /// Largest angle between its axis and light of it [radians].
    double widest() const { return widest_; }
    /// Angle over which it fades towards its sides, or sine of that [radians].
    double fading() const { return outer_ - inner_; }

    /// Whether another lamp sends the same share of its power into each direction.
    bool shinesAs(const Beam& other) const;
    /// One with the power of several lamps that shine as this one. It stands in the shade that this one stands in,
    /// which outlives it.
    Beam inPlaceOfMore(const glm::dvec3& position, const glm::dvec3& power, double radius) const;
    /// A point lamp as bright everywhere as this one at its brightest. It stands in no shade.
    Beam everywhere() const;

    /// Radiant intensity in a direction away from the lamp [W/sr].
    glm::dvec3 intensity(const glm::dvec3& direction) const { return share(direction) * lamp_.power; }
    /// The same over the lamp's power [1/sr].
    double share(const glm::dvec3& direction) const;

    /// Adds the distances at which a ray meets the sides of the light, where its intensity has corners [m].
    void addCorners(const Ray& ray, std::vector<double>& distances) const;

    /// Whether it lights all directions alike.
    bool isPoint() const { return lamp_.kind == scene::LampKind::point; }

    /// Lets clouds stand in its light. `edge`: directions across the map of their shade. Errors: what `check` throws.
    void shadeBy(const Clouds& clouds, int edge, const Check& check);
    /// Lets solid bodies stand in its light, as above.
    void shadeBy(const Solids& solids, int edge, const Check& check);
    /// Whether clouds or solid bodies may stand in its light.
    bool isShaded() const { return shadedAs_ != nullptr ? shadedAs_->isShaded() : !shade_.empty() || !solids_.empty(); }
    /// Share of the light that clouds and solid bodies let through into a direction up to a distance [m].
    double passed(const glm::dvec3& direction, double distance) const {
        if (shadedAs_ != nullptr) return shadedAs_->passed(direction, distance);
        const double past = solids_.transmittance(direction, distance);
        return past > 0.0 ? past * shade_.transmittance(direction, distance) : 0.0;
    }

    /// A direction drawn by intensity from numbers in [0, 1); false where these give none and others have to be tried.
    bool sample(const glm::dvec3& u, glm::dvec3& direction) const;

  private:
    double spotShare(const glm::dvec3& direction) const;
    double pyramidShare(const glm::dvec3& direction) const;

    scene::Lamp lamp_;
    DepthMap shade_, solids_;
    const Beam* shadedAs_ = nullptr;
    glm::dvec3 level_, rising_;  ///< unit vectors square to the axis; of a pyramid, each square to two sides
    double inner_, outer_;       ///< angles to the axis, or to a plane through it, between which the light fades
    double widest_;              ///< largest angle to the axis
    double perSolidAngle_;       ///< share where it does not fade [1/sr]
};

}  // namespace lumulus::lamp
