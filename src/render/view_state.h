#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "cloud/atlas.h"
#include "draw/billboards.h"
#include "draw/instance_tiles.h"
#include "draw/sparse_sampling.h"
#include "frame/frame.h"
#include "frame/map_pass.h"
#include "frame/sky_pass.h"
#include "light/light_field.h"
#include "render/renderer.h"
#include "surface/mesh/mesh_picture.h"
#include "view/camera.h"

namespace lumulus {

/// The light of one instance as a viewer sees it.
struct InstanceView {
    std::optional<light::LightField> field;
    std::optional<glm::vec3> eye;  ///< in voxel coordinates, that the field was made for; none: it is not up to date
    std::uint64_t version = 0;     ///< of the instance's light that it was made of
};

/// What belongs to a viewer and outlives a frame.
struct ViewState::State {
    Camera camera;        ///< of the picture that is drawn
    Camera previous;      ///< of the picture before
    Tile tile;            ///< the part of the picture that is drawn
    Tile shown;           ///< what of the tile the clouds may be seen in: the rest is background
    bool sunDisc = true;  ///< whether the discs of sun and moon are seen
    bool coarse = false;  ///< the picture is (View::coarse)
    int raysAcross = 1;
    int spacing = 1;                          ///< of the points of sparse sampling in pixels; 1: every pixel is drawn
    int sampledRowsDrawn = 0;                 ///< of this picture's points
    std::vector<InstanceView> instances;      ///< of all instances of the world
    std::optional<cloud::Atlas> lightFields;  ///< where the world has several visible instances
    std::map<int, draw::Interpolation> interpolations;  ///< by spacing
    std::optional<draw::Billboards::View> billboards;
    std::optional<frame::Frame> frame;          ///< where passes follow the drawing
    std::optional<frame::SkyPass> sky;          ///< where the sky is an atmosphere
    std::optional<frame::MapPass> map;          ///< where it is a map
    std::optional<surface::MeshPixels> meshes;  ///< where the picture shows meshes
    std::optional<draw::InstanceTiles> tiles;   ///< where the world has several visible instances
};

}  // namespace lumulus
