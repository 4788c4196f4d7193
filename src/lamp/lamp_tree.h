#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lamp/beam.h"

namespace lumulus::lamp {

/// Mean of the channels as the eye weighs them (Rec. 709).
inline double luminanceOf(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// A lamp, or one lamp in the place of several that send their light into the same directions.
struct LampNode {
    std::size_t number = 0;
    const Beam* beam = nullptr;
    const Beam* bound = nullptr;  ///< a point lamp that is nowhere darker
    double reach = 0.0;           ///< largest distance of one of them from the place of `beam` [m]
    double variance = 0.0;        ///< mean square of these distances, by luminance [m²]
    double shift = 0.0;           ///< largest distance of a channel's mean place from that of `beam` [m]
    const LampNode* parts[2] = {nullptr, nullptr};  ///< nodes that it stands for

    bool isOne() const { return parts[0] == nullptr; }
};

/// What a place has of the light of a node.
struct NodeLight {
    const LampNode* node = nullptr;
    glm::dvec3 light{0.0};
    double bound = 0.0;  ///< luminance of light that it does not exceed by much
    double error = 0.0;  ///< share of `bound` that is wrong because the node stands for several; infinite: it cannot
};

/// Lamps in groups, and these in larger ones: a place takes for each group one lamp, where that makes little of a
/// difference (after Walter et al. 2005, "Lightcuts").
class LampTree {
  public:
    /// `beams` outlive it.
    explicit LampTree(std::span<const Beam> beams);

    /// The largest groups of which some lamps may be wanted: `isWanted` says so of a LampNode.
    template <class IsWanted>
    std::vector<const LampNode*> groups(const IsWanted& isWanted) const {
        std::vector<const LampNode*> found;
        for (const LampNode* root : roots_)
            if (isWanted(*root)) found.push_back(root);
        return found;
    }

    /// Groups of `from` for a place, so that the error of each is at most `tolerance` of the light of all,
    /// `done` of which comes from others. `measure`
    /// makes a NodeLight of a LampNode; nodes whose bound is 0 are left out. `found`: what was there is lost.
    template <class Measure>
    static void cut(std::span<const LampNode* const> from, double tolerance, double done, const Measure& measure,
                    std::vector<NodeLight>& found) {
        double all = done;
        found.clear();
        const auto take = [&](const LampNode& node) {
            const NodeLight& one = found.emplace_back(measure(node));
            if (!(one.bound > 0.0)) return found.pop_back();
            all += luminanceOf(one.light);
            std::ranges::push_heap(found, isLess);
        };
        for (const LampNode* group : from) take(*group);
        while (!found.empty() && wrong(found.front()) > tolerance * all) {
            std::ranges::pop_heap(found, isLess);
            const NodeLight split = found.back();
            found.pop_back();
            all = std::max(done, all - luminanceOf(split.light));
            for (const LampNode* part : split.node->parts) take(*part);
        }
    }

  private:
    static double wrong(const NodeLight& one) { return one.node->isOne() ? 0.0 : one.bound * one.error; }
    static bool isLess(const NodeLight& a, const NodeLight& b) {
        return wrong(a) != wrong(b) ? wrong(a) < wrong(b) : a.node->number > b.node->number;
    }
    const LampNode* build(std::span<const Beam*> beams);
    const Beam* boundOf(const Beam& beam);

    std::deque<LampNode> nodes_;
    std::vector<const LampNode*> roots_;
    std::deque<Beam> joined_;
};

}  // namespace lumulus::lamp
