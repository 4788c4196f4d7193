#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/image.h"
#include "scene/scene.h"

namespace lumulus::python {

/// A picture as a mapping from names of layers to arrays of float32, height × width × channels, rows from the top. The
/// layer "RGB" has the channels R, G and B; "cloud" those that begin with "cloud."; "cloud.A" is one channel alone.
class Picture {
  public:
    Picture(LayeredImage image, scene::Image how) : image_(std::move(image)), how_(how) {}
    /// From arrays by name. Errors: InputError for shapes and types that make no picture.
    explicit Picture(const pybind11::dict& arrays);

    const LayeredImage& image() const { return image_; }
    /// Names of the layers, each with the channels that it has, in the order of the last axis.
    std::map<std::string, std::vector<std::string>> layers() const;
    /// Channels of a layer or of a channel by its name; empty where there is none.
    std::vector<std::string> channels(const std::string& name) const;
    /// Errors: KeyError where the picture has no such layer.
    pybind11::array_t<float> array(const std::string& name) const;
    /// Writes an .exr or a .png as `lumulus render` does. Errors: those of writing files.
    void write(const std::filesystem::path& path) const;

  private:
    LayeredImage image_;
    scene::Image how_;
};

/// A picture, as it is or from the file of this name. Errors: InputError.
const Picture& pictureOf(const pybind11::object& pictureOrPath, pybind11::object& keep);

void definePicture(pybind11::module_& module);

}  // namespace lumulus::python
