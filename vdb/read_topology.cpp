#include "vdb/read_topology.h"

#include <memory>

namespace lumulus::vdb {
namespace {

template <typename Value>
void readValue(std::istream& in, Value& value) {
    in.read(reinterpret_cast<char*>(&value), sizeof(Value));
}

/// Forgets the children of a node that have not been read: until then their places hold the bits of the background,
/// which the node would take for pointers when it is freed.
template <typename Node>
void forgetUnread(Node& node, const typename Node::ValueType& background) {
    typename Node::UnionType unread;
    unread.setValue(background);
    for (auto child = node.getChildMask().beginOn(); child; ++child) {
        auto& place = const_cast<typename Node::UnionType&>(node.getTable()[child.pos()]);
        if (place.getChild() == unread.getChild()) place.setChild(nullptr);
    }
}

/// Reads a node below the root.
template <typename Node>
std::unique_ptr<Node> readNode(std::istream& in, const openvdb::Coord& origin,
                               const typename Node::ValueType& background, bool asHalf) {
    using Below = typename Node::ChildNodeType;
    // filled with zeros: null pointers where children have not been read
    auto node = std::make_unique<Node>(openvdb::PartialCreate(), origin, openvdb::zeroVal<typename Node::ValueType>());
    try {
        node->readTopology(in, asHalf);
    } catch (...) {
        for (auto child = node->getChildMask().beginOn(); child; ++child) {
            Below* below = node->getTable()[child.pos()].getChild();
            if (below != nullptr) forgetUnread(*below, background);
        }
        throw;
    }
    return node;
}

template <typename Tree>
void readTree(Tree& tree, std::istream& in, bool asHalf) {
    using Root = typename Tree::RootNodeType;
    using Value = typename Tree::ValueType;
    std::int32_t buffers = 0;  // of each leaf; always one
    readValue(in, buffers);
    tree.clear();
    Root& root = tree.root();
    Value background;
    readValue(in, background);
    constexpr bool inNodesToo = false;
    root.setBackground(background, inNodesToo);
    openvdb::io::setGridBackgroundValuePtr(in, &root.background());

    std::uint32_t tiles = 0, children = 0;
    readValue(in, tiles);
    readValue(in, children);
    const auto readPlace = [&in] {
        std::int32_t place[3];
        readValue(in, place);
        return openvdb::Coord(place);
    };
    for (std::uint32_t i = 0; i < tiles; ++i) {
        const openvdb::Coord place = readPlace();
        Value value;
        char active = 0;
        readValue(in, value);
        readValue(in, active);
        root.addTile(place, value, active != 0);
    }
    for (std::uint32_t i = 0; i < children; ++i) {
        const openvdb::Coord place = readPlace();
        root.addChild(readNode<typename Root::ChildNodeType>(in, place, background, asHalf).release());
    }
}

}  // namespace

void readTopology(openvdb::GridBase& grid, std::istream& in) {
    using Known = openvdb::NumericGridTypes::Append<openvdb::Vec3GridTypes>;
    const bool asHalf = grid.saveFloatAsHalf();
    const bool known = grid.apply<Known>([&](auto& typed) { readTree(typed.tree(), in, asHalf); });
    if (!known) grid.readTopology(in);
}

}  // namespace lumulus::vdb
