#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "query/bricks.h"

namespace lumulus::query {

/// A straight way through the world, metres.
struct Way {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 1.0, 0.0};  ///< unit vector
    double length = std::numeric_limits<double>::infinity();

    /// From one point to another, also where they are the same.
    static Way between(const glm::dvec3& from, const glm::dvec3& to);
};

/// A density field where one cloud has it.
struct PlacedField {
    std::shared_ptr<const BrickField> field;  ///< shared by the clouds that show it; never null
    glm::dmat3 voxelToMetres{1.0};
    glm::dvec3 origin{0.0};   ///< where the corner of voxel (0,0,0) lies [m]
    double extinction = 0.0;  ///< 1/m at density 1
};

/// The same of a cloud of a scene.
struct CloudField {
    std::size_t cloud = 0;  ///< its number in the scene
    PlacedField placed;
};

/// A box along the axes of the world, metres.
struct Extent {
    glm::dvec3 lower{0.0}, upper{0.0};
};

/// Clouds through which light goes in straight lines. Where they overlap, their optical depths add up.
class Clouds {
  public:
    Clouds() = default;
    explicit Clouds(std::vector<PlacedField> fields);

    std::size_t size() const { return parts_.size(); }
    /// The same clouds, all moved by so far [m].
    Clouds movedBy(const glm::dvec3& way) const;
    /// Memory of the different fields.
    std::uint64_t bytes() const;
    /// The box of all of them; absent where there is none.
    std::optional<Extent> extent() const;
    /// Smallest edge of a cube of a voxel's volume [m]; 0 where there is no cloud.
    double finestVoxel() const;
    /// Optical depth of all clouds along a way, without noise.
    double opticalDepth(const Way& way) const;

  private:
    struct Box {
        glm::dvec3 lower{std::numeric_limits<double>::infinity()};
        glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

        void add(const Box& other);
    };
    struct Part {
        PlacedField placed;
        glm::dmat3 metresToVoxel;
        Box box;
    };
    /// A node of the tree of boxes: its parts are those from `first` on; an inner node's first child is the next node.
    struct Node {
        Box box;
        std::size_t first = 0, count = 0;  ///< count 0: an inner node
        std::size_t second = 0;            ///< number of its second child
    };

    void split(std::size_t first, std::size_t count);
    double depthOf(const Part& part, const Way& way) const;

    std::vector<Part> parts_;
    std::vector<Node> nodes_;
};

}  // namespace lumulus::query
