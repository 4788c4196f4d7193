#include "volume/motion.h"

#include "volume/source.h"

namespace lumulus {

CloudVelocity::CloudVelocity(const scene::Cloud& cloud, const vdb::VoxelBox& density, const vdb::ReadLimits& limits)
    : field_(vdb::VelocityField::read(cloud.vdb, density, limits)), told_(cloud.velocity) {}

glm::dvec3 CloudVelocity::at(const glm::dvec3& place) const {
    if (field_) return field_->at(place);
    return told_ ? told_->at(place.y) : glm::dvec3(0.0);
}

glm::dvec3 CloudVelocity::carried(const glm::dvec3& place, double seconds) const {
    return place + seconds * at(place + 0.5 * seconds * at(place));
}

CloudMotion motionBetween(const scene::Cloud& before, const scene::Cloud& now, const vdb::VoxelBox& density,
                          const vdb::ReadLimits& limits) {
    CloudMotion motion;
    if (sourceOf(before) == sourceOf(now)) return motion;
    const bool sequence = before.moment && now.moment && before.moment->name == now.moment->name;
    if (!sequence) {
        motion.known = false;
        return motion;
    }
    const double files = now.moment->file - before.moment->file;
    motion.goesOn = files >= 0.0 || now.sequence.extend != scene::Extend::repeat;
    const auto velocity = std::make_shared<const CloudVelocity>(now, density, limits);
    motion.known = velocity->isKnown();
    const double seconds = files / now.moment->fps;
    if (motion.known && motion.goesOn)
        motion.way = [velocity, seconds](const glm::dvec3& place) {
            return place - velocity->carried(place, -seconds);
        };
    return motion;
}

}  // namespace lumulus
