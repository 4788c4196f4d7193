#include "vdb/load_sparse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "vdb/examine.h"
#include "vdb/file.h"
#include "vdb/leaf_reader.h"
#include "vdb/transform.h"
#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

/// Leaves that are looked at together, in parallel.
constexpr std::size_t together = 4096;
/// Bricks that tiles may be divided into.
constexpr double mostTileBricks = 8388608.0;

glm::ivec3 toGlm(const openvdb::Coord& at) {
    return {at.x(), at.y(), at.z()};
}

openvdb::Coord toCoord(const glm::ivec3& at) {
    return {at.x, at.y, at.z};
}

/// The brick that holds an index coordinate, counted from that of the index (0,0,0).
glm::ivec3 brickOf(const glm::ivec3& at) {
    return at >> 3;
}

double bricksIn(const openvdb::CoordBBox& box) {
    const glm::dvec3 extent(glm::i64vec3(toGlm(box.max())) - glm::i64vec3(toGlm(box.min())) + std::int64_t{1});
    return extent.x * extent.y * extent.z / 512.0;
}

/// The choice of load(), but that a grid counts as filled by its structure: no values are read.
GridChoice choose(const std::filesystem::path& path, const LoadOptions& options) {
    GridFile probe(path, options.limits);
    std::vector<GridLabel> labels = probe.labels();
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (!probe.hasStream(i)) continue;
        labels[i].hasContent = [&probe, i] { return probe.readStructure(i)->activeVoxelCount() > 0; };
    }
    return chooseGrid(labels, options.grid, path.string(), options.keys + ".grid");
}

/// Makes the table of one grid's leaves.
class Tabler {
  public:
    Tabler(GridFile& file, std::size_t index, const LoadOptions& options, const std::string& path)
        : file_(file), index_(index), options_(options), path_(path) {}

    SparseResult make() {
        const bool streams = file_.hasStream(index_);
        const openvdb::FloatGrid::Ptr grid = streams ? file_.readStructure(index_) : asFloats(file_.read(index_));
        Examiner examiner(*grid, options_, path_);
        if (streams)
            stream(*grid);
        else
            walk(grid);
        addTiles(grid->tree());
        examiner.warnOfBackground(static_cast<double>(grid->tree().background()));
        examiner.hasBadValues(survey_);
        const IndexBox box = examiner.cropped(survey_, grid->tree().activeVoxelCount() > 0);
        survey_.blocks = {};
        return result(*grid, examiner, box);
    }

  private:
    void stream(openvdb::FloatGrid& grid) {
        SparseField batch;
        std::vector<float> kept;
        kept.reserve(together * LeafTable::values);
        file_.streamLeaves(grid, [&](Leaf& leaf, std::uint64_t place) {
            for (auto value = leaf.beginValueOff(); value; ++value) value.setValue(0.0F);
            const std::size_t first = kept.size();
            kept.insert(kept.end(), leaf.buffer().data(), leaf.buffer().data() + LeafTable::values);
            note(leaf, place, &kept[first], batch);
            if (batch.blocks.size() < together) return;
            finish(batch);
            kept.clear();
        });
        finish(batch);
        auto reader =
            std::make_shared<LeafReader>(path_, file_.storage(), grid.tree().background(), grid.saveFloatAsHalf());
        table_.read = [reader](const LeafTable::Leaf& leaf, LeafTable::Values values) {
            reader->read(leaf.source, values);
        };
    }

    void walk(const openvdb::FloatGrid::Ptr& grid) {
        auto leaves = std::make_shared<std::vector<Leaf*>>();
        grid->tree().getNodes(*leaves);
        SparseField batch;
        for (std::size_t i = 0; i < leaves->size(); ++i) {
            Leaf& leaf = *(*leaves)[i];
            for (auto value = leaf.beginValueOff(); value; ++value) value.setValue(0.0F);
            note(leaf, i, leaf.buffer().data(), batch);
            if (batch.blocks.size() >= together) finish(batch);
        }
        finish(batch);
        table_.read = [grid, leaves](const LeafTable::Leaf& leaf, LeafTable::Values values) {
            leafValues(*(*leaves)[leaf.source], values);
        };
    }

    /// Notes what a leaf is. `values` stay until finish().
    void note(const Leaf& leaf, std::uint64_t place, float* values, SparseField& batch) {
        const glm::ivec3 origin = toGlm(leaf.origin());
        batch.blocks.push_back({{origin, origin + (LeafTable::edge - 1)}, values, 0.0F});
        LeafTable::Leaf entry;
        float ordered[LeafTable::values];
        leafValues(leaf, LeafTable::Values(ordered));
        measureLeaf(entry, std::span<const float, LeafTable::values>(ordered));
        entry.at = brickOf(origin);
        entry.source = place;
        if (entry.most > 0.0F) table_.leaves.push_back(entry);
    }

    void finish(SparseField& batch) {
        append(survey_, surveyField(batch, options_.limits.check));
        batch.blocks.clear();
    }

    void addTiles(const openvdb::FloatTree& tree) {
        SparseField tiles;
        double bricks = 0.0;
        forTiles(tree.root(), [&](const openvdb::CoordBBox& box, float value) {
            tiles.blocks.push_back({{toGlm(box.min()), toGlm(box.max())}, nullptr, value});
            bricks += bricksIn(box);
        });
        if (bricks > mostTileBricks)
            throw InputError(fmt::format("the tiles of the grid are {:.3g} bricks of 8^3 voxels, more than {:.3g}",
                                         bricks, mostTileBricks),
                             path_, "resample the grid to larger voxels, or set preparation.storage = \"dense\"");
        append(survey_, surveyField(tiles, options_.limits.check));
        for (const Block& tile : tiles.blocks) {
            if (!(std::isfinite(tile.tile) && tile.tile > 0.0F)) continue;
            LeafTable::Leaf leaf;
            leaf.least = leaf.most = tile.tile;
            leaf.mass = static_cast<float>(LeafTable::values) * tile.tile;
            leaf.touches = 7;
            const IndexBox box{brickOf(tile.box.minimum), brickOf(tile.box.maximum)};
            forEachVoxel(box, [&](const glm::ivec3& at) {
                leaf.at = at;
                table_.leaves.push_back(leaf);
            });
        }
    }

    /// The volume on whole leaves around the box with a ring of zeros.
    SparseResult result(const openvdb::FloatGrid& grid, const Examiner& examiner, const IndexBox& box) {
        SparseResult result;
        SparseVolume& volume = result.volume;
        const glm::ivec3 first = brickOf(box.minimum - 1), last = brickOf(box.maximum + 1);
        std::erase_if(table_.leaves, [&](const LeafTable::Leaf& leaf) {
            return glm::any(glm::lessThan(leaf.at, first)) || glm::any(glm::greaterThan(leaf.at, last));
        });
        for (LeafTable::Leaf& leaf : table_.leaves) {
            leaf.at -= first;
            volume.maximum = std::max(volume.maximum, leaf.most);
        }
        table_.leaves.shrink_to_fit();
        volume.size = LeafTable::edge * (last - first + 1);
        volume.leaves = std::move(table_);
        volume.name = grid.getName();
        result.gridToWorld = examiner.gridToWorld();
        result.voxelToGrid.translation = glm::dvec3(LeafTable::edge * first) - 0.5;
        volume.toWorld = composed(result.gridToWorld, result.voxelToGrid);
        result.warnings = examiner.warnings();
        return result;
    }

    GridFile& file_;
    std::size_t index_;
    const LoadOptions& options_;
    const std::string& path_;
    LeafTable table_;
    Survey survey_;
};

}  // namespace

GridOutline outline(const std::filesystem::path& path, const LoadOptions& options) {
    const GridChoice choice = choose(path, options);
    GridFile file(path, options.limits);
    const openvdb::FloatGrid::Ptr grid =
        file.hasStream(choice.index) ? file.readStructure(choice.index) : asFloats(file.read(choice.index));
    GridOutline outline;
    openvdb::CoordBBox box;
    const auto take = [&](const openvdb::CoordBBox& node) {
        openvdb::CoordBBox taken = node;
        if (options.part) taken.intersect({toCoord((*options.part)[0]), toCoord((*options.part)[1])});
        if (taken.empty()) return;
        box.expand(taken);
        outline.bricks += bricksIn(taken);
    };
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) take(leaf->getNodeBoundingBox());
    forTiles(grid->tree().root(), [&](const openvdb::CoordBBox& tile, float) { take(tile); });
    if (box.empty()) return outline;
    const glm::i64vec3 extent = glm::i64vec3(toGlm(box.max())) - glm::i64vec3(toGlm(box.min())) + std::int64_t{3};
    outline.longest = std::max({extent.x, extent.y, extent.z});
    outline.filled = outline.bricks / std::max(bricksIn(box), 1.0);
    outline.roots = bricksIn(box) / SparseVolume::nodeEntries;
    outline.denseMiB = 2.0 * glm::dvec3(extent).x * glm::dvec3(extent).y * glm::dvec3(extent).z / 1048576.0;
    return outline;
}

SparseResult loadSparse(const std::filesystem::path& path, const LoadOptions& options) {
    GridChoice choice = choose(path, options);
    GridFile file(path, options.limits);
    SparseResult result = Tabler(file, choice.index, options, path.string()).make();
    result.warnings.insert(result.warnings.begin(), std::make_move_iterator(choice.warnings.begin()),
                           std::make_move_iterator(choice.warnings.end()));
    return result;
}

}  // namespace lumulus::vdb
