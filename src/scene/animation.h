#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/toml.h"

namespace lumulus::scene {

/// How values between two keys of an animation are found.
enum class Interpolation { linear, smooth, step, spline };

/// The values of one key of a scene over the frames.
struct AnimatedKey {
    std::string path;   ///< of the scene's key, "cloud.0.extinction"
    std::string where;  ///< "x.toml:14, animate.cloud.0.extinction"
    Interpolation interpolation = Interpolation::linear;
    bool whole = false;                        ///< whether values are whole numbers
    std::string shape;                         ///< the value as TOML, with # in the place of each number
    std::vector<double> frames;                ///< rising
    std::vector<std::vector<double>> numbers;  ///< of the value at each of `frames`
    std::vector<std::string> texts;            ///< the same where values are no numbers

    /// The value at a frame, as TOML. Before the first and behind the last key it stays.
    std::string valueAt(double frame) const;
};

/// The section [animate] of a scene: keys whose values change from frame to frame.
class Animation {
  public:
    Animation() = default;
    /// A camera path is looked for beside the scene; if `folders` are given, it has to lie in one of them. Errors:
    /// InputError that names file, line and key.
    Animation(const toml::node& section, const std::string& source, std::span<const std::filesystem::path> folders);

    const std::vector<AnimatedKey>& keys() const { return keys_; }
    /// Frames a second.
    double fps() const { return fps_; }

  private:
    void read(const toml::node& node, const std::string& path, const std::string& source);
    void readCamera(const std::filesystem::path& path);

    std::vector<AnimatedKey> keys_;
    double fps_ = 24.0;
};

}  // namespace lumulus::scene
