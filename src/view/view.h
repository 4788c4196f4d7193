#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "scene/scene.h"
#include "view/camera.h"

namespace lumulus {

/// Edges of an off-axis pyramid of view as tangents, seen from the eye: left < right, bottom < top.
struct Frustum {
    double left = -1.0, right = 1.0, bottom = -1.0, top = 1.0;

    bool operator==(const Frustum&) const = default;
};

/// A part of a picture: pixels from the upper left corner of the whole.
struct Tile {
    int x = 0, y = 0, width = 1, height = 1;

    bool operator==(const Tile&) const = default;
};

/// What a picture shows, and how much of it is wanted.
struct View {
    scene::Camera camera;
    scene::Image image;                     ///< the whole picture, also where only a tile is drawn
    std::optional<glm::dquat> orientation;  ///< rotates camera axes (+X right, +Y up, −Z forward) into the world's;
                                            ///< instead of target and up
    std::optional<Frustum> frustum;         ///< instead of the angle; perspective only
    std::optional<Tile> tile;               ///< drawn alone, bit for bit as in the whole
    int mostRays = 4;                       ///< along each side of a pixel, where pixels are larger than voxels
    bool coarse = false;                    ///< to be enlarged: light in larger cells, fewer texels of air before the
                                            ///< clouds, and the sky of an eye nearby serves
    bool sunDisc = true;                    ///< whether discs of sun and moon are seen where nothing is before them

    bool operator==(const View&) const = default;
};

/// The camera of a view. Errors: those of the makeCamera of a scene; InputError for an orientation of no length, an
/// empty frustum or one for another projection.
Camera makeCamera(const View& view, const Bounds& cloud);

/// The camera of a window of a picture, which may reach beyond it: the same rays through the same pixels, counted from
/// the window's corner. Errors: InputError for a panorama unless the window is the whole picture.
Camera windowCamera(const Camera& camera, const Tile& window);

/// The part that is drawn: the tile, or everything. Errors: InputError for a tile that is not within the picture.
Tile drawnTile(const View& view);

}  // namespace lumulus
