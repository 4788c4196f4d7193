#include "lamp/lamp_tree.h"

#include <array>

namespace lumulus::lamp {

namespace {

/// The lamps, those that are alike in one group.
std::vector<std::vector<const Beam*>> alike(std::span<const Beam> beams) {
    std::vector<std::vector<const Beam*>> groups;
    for (const Beam& beam : beams) {
        const auto found = std::ranges::find_if(groups, [&](const auto& group) {
            return group.front()->shinesAs(beam) && group.front()->isShaded() == beam.isShaded();
        });
        (found != groups.end() ? *found : groups.emplace_back()).push_back(&beam);
    }
    return groups;
}

}  // namespace

LampTree::LampTree(std::span<const Beam> beams) {
    for (std::vector<const Beam*>& group : alike(beams)) roots_.push_back(build(group));
}

const Beam* LampTree::boundOf(const Beam& beam) {
    return beam.isPoint() ? &beam : &joined_.emplace_back(beam.everywhere());
}

const LampNode* LampTree::build(std::span<const Beam*> beams) {
    if (beams.size() == 1)
        return &nodes_.emplace_back(LampNode{.number = nodes_.size(), .beam = beams[0], .bound = boundOf(*beams[0])});
    glm::dvec3 power(0.0), lower(beams[0]->position()), upper(lower);
    glm::dmat3 places(0.0);  // a column a channel
    double radius = 0.0, light = 0.0;
    glm::dvec3 middle(0.0);
    const Beam* brightest = beams[0];
    for (const Beam* beam : beams) {
        const double luminance = luminanceOf(beam->power());
        power += beam->power();
        light += luminance;
        middle += luminance * beam->position();
        places += glm::outerProduct(beam->position(), beam->power());
        radius = std::max(radius, beam->radius());
        lower = glm::min(lower, beam->position());
        upper = glm::max(upper, beam->position());
        if (luminance > luminanceOf(brightest->power())) brightest = beam;
    }
    middle /= light;
    LampNode node;
    for (glm::length_t c = 0; c < 3; ++c)
        if (power[c] > 0.0) node.shift = std::max(node.shift, glm::distance(places[c] / power[c], middle));
    for (const Beam* beam : beams) {
        const double away = glm::distance(beam->position(), middle);
        node.reach = std::max(node.reach, away);
        node.variance += luminanceOf(beam->power()) / light * away * away;
    }
    node.beam = &joined_.emplace_back(brightest->inPlaceOfMore(middle, power, radius));
    node.bound = boundOf(*node.beam);
    const glm::dvec3 size = upper - lower;
    const glm::length_t axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    std::ranges::sort(beams, [&](const Beam* a, const Beam* b) {
        const double one = a->position()[axis], other = b->position()[axis];
        return one != other ? one < other : a < b;
    });
    node.parts[0] = build(beams.subspan(0, beams.size() / 2));
    node.parts[1] = build(beams.subspan(beams.size() / 2));
    node.number = nodes_.size();
    return &nodes_.emplace_back(node);
}

}  // namespace lumulus::lamp
