#include "prefilter/layouts.h"

#include <ImfEnvmap.h>

#include <cmath>

#include "prefilter/panorama.h"

namespace lumulus::prefilter {

std::vector<glm::vec3> openExrCube(int size) {
    const Imath::Box2i window({0, 0}, {size - 1, 6 * size - 1});
    std::vector<glm::vec3> directions(static_cast<std::size_t>(6) * static_cast<std::size_t>(size * size));
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const auto name = static_cast<Imf::CubeMapFace>(face);
                const Imath::V2f place(static_cast<float>(x), static_cast<float>(y));
                const Imath::V2f pixel = Imf::CubeMap::pixelPosition(name, window, place);
                const Imath::V3f d = Imf::CubeMap::direction(name, window, place);
                const auto row = static_cast<std::size_t>(std::lround(pixel.y));
                const auto column = static_cast<std::size_t>(std::lround(pixel.x));
                directions[row * static_cast<std::size_t>(size) + column] = glm::normalize(glm::vec3(d.x, d.y, d.z));
            }
    return directions;
}

std::vector<glm::vec3> graphicsFace(int face, int size) {
    std::vector<glm::vec3> directions;
    directions.reserve(static_cast<std::size_t>(size * size));
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const float s = (2.0F * static_cast<float>(x) + 1.0F) / static_cast<float>(size) - 1.0F;
            const float t = (2.0F * static_cast<float>(y) + 1.0F) / static_cast<float>(size) - 1.0F;
            const std::array<glm::vec3, 6> on{
                {{1.0F, -t, -s}, {-1.0F, -t, s}, {s, 1.0F, t}, {s, -1.0F, -t}, {s, -t, 1.0F}, {-s, -t, -1.0F}}};
            directions.push_back(glm::normalize(on[static_cast<std::size_t>(face)]));
        }
    return directions;
}

std::vector<glm::vec3> latLong(int width, int height) {
    const Panorama shape{width, height, {}};
    std::vector<glm::vec3> directions;
    directions.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) directions.emplace_back(shape.direction(x + 0.5, y + 0.5));
    return directions;
}

}  // namespace lumulus::prefilter
