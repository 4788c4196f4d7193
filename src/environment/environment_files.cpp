#include "environment/environment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "base/exr.h"
#include "base/exr_mip.h"
#include "environment/conventions.h"
#include "prefilter/brdf_table.h"
#include "prefilter/layouts.h"

namespace lumulus::environment {
namespace {

namespace fs = std::filesystem;

/// env.exr → env_NAME.exr.
fs::path beside(const fs::path& output, const std::string& name) {
    return output.parent_path() / (output.stem().string() + "_" + name + ".exr");
}

LayeredImage imageOf(int width, int height, std::span<const glm::vec3> pixels) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    std::vector<float>&red = image.layer("R"), &green = image.layer("G"), &blue = image.layer("B");
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        red[i] = pixels[i].r;
        green[i] = pixels[i].g;
        blue[i] = pixels[i].b;
    }
    return image;
}

glm::vec3 meanOf(std::span<const glm::vec3> pixels) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& pixel : pixels) sum += glm::dvec3(pixel);
    return glm::vec3(sum / static_cast<double>(pixels.size()));
}

/// Makes the files one after the other.
class Maker {
  public:
    Maker(const Surroundings& surroundings, const FileOptions& options,
          const std::map<std::string, std::string>& attributes, const Report& report, const Check& check)
        : surroundings_(surroundings),
          options_(options),
          attributes_(attributes),
          report_(report),
          check_(check),
          filter_(options.method, surroundings.panorama, options.levels.front().size, check),
          steps_(1 + (options.byLevel ? 1 : 0) + (options.byFace ? 6 : 0)) {
        report_("filtering", 0, steps_);
    }

    /// All levels in the layout of OpenEXR. The format wants levels down to one pixel in all: those that are no map of
    /// six faces have one colour.
    std::vector<std::byte> cube() {
        const int size = options_.levels.front().size, count = mipLevels(size, 6 * size);
        std::vector<LayeredImage> images;
        std::vector<glm::vec3> pixels;
        for (int i = 0; i < count; ++i) {
            const int width = std::max(1, size >> i), height = std::max(1, (6 * size) >> i);
            if (height == 6 * width) {
                const std::size_t level = std::min(static_cast<std::size_t>(i), options_.levels.size() - 1);
                pixels = filter_.filtered({options_.levels[level].roughness, width}, prefilter::openExrCube(width));
            } else {
                pixels.assign(static_cast<std::size_t>(width * height), meanOf(pixels));
            }
            images.push_back(imageOf(width, height, pixels));
        }
        images.front().attributes = attributes_;
        done();
        return encodeMipMapped(images, true);
    }
    std::vector<std::byte> latLong(std::size_t number) {
        const prefilter::Panorama& whole = surroundings_.panorama;
        if (number == 0) return encoded(imageOf(whole.width, whole.height, whole.pixels), 0);
        const Level& level = options_.levels[number];
        const int width = 4 * level.size, height = 2 * level.size;
        return encoded(imageOf(width, height, filter_.filtered(level, prefilter::latLong(width, height))), number);
    }
    std::vector<std::byte> face(std::size_t number, int face) {
        const Level& level = options_.levels[number];
        return encoded(
            imageOf(level.size, level.size, filter_.filtered(level, prefilter::graphicsFace(face, level.size))),
            number);
    }
    std::vector<std::byte> brdf() const {
        constexpr int size = 64;
        const bool thesis = options_.method == Method::thesis;
        LayeredImage table =
            prefilter::brdfTable(thesis ? prefilter::BrdfModel::cookTorrance : prefilter::BrdfModel::ggx, size, check_);
        table.attributes["environment.brdf"] = brdfText(options_.method);
        return encodeExr(table, options_.output.string());
    }
    void done() { report_("filtering", ++made_, steps_); }

  private:
    std::vector<std::byte> encoded(LayeredImage image, std::size_t level) const {
        check_();
        image.attributes = attributes_;
        image.attributes["environment.roughness"] = fmt::format("{:g}", options_.levels[level].roughness);
        return encodeExr(image, options_.output.string());
    }

    const Surroundings& surroundings_;
    const FileOptions& options_;
    const std::map<std::string, std::string>& attributes_;
    const Report& report_;
    const Check& check_;
    LevelFilter filter_;
    std::uint64_t steps_, made_ = 0;
};

}  // namespace

std::vector<fs::path> namesOf(const FileOptions& options) {
    const fs::path& output = options.output;
    std::vector<fs::path> names{output, fs::path(output).replace_extension(".json"), beside(output, "latlong"),
                                beside(output, "brdf")};
    for (std::size_t i = 0; options.byLevel && i < options.levels.size(); ++i)
        names.push_back(beside(output, fmt::format("m{}", i)));
    for (const char* face : prefilter::faceNames)
        for (std::size_t i = 0; options.byFace && i < options.levels.size(); ++i)
            names.push_back(beside(output, fmt::format("m{}_{}", i, face)));
    return names;
}

std::vector<File> filesOf(const Surroundings& surroundings, const scene::Scene& scene, const FileOptions& options,
                          const Report& report, const Check& check) {
    const Conventions conventions = conventionsOf(surroundings, scene, options);
    Maker maker(surroundings, options, conventions.attributes, report, check);
    const auto json = std::as_bytes(std::span(conventions.json));
    std::vector<std::vector<std::byte>> contents;
    contents.push_back(maker.cube());
    contents.emplace_back(json.begin(), json.end());
    contents.push_back(maker.latLong(0));
    contents.push_back(maker.brdf());
    for (std::size_t i = 0; options.byLevel && i < options.levels.size(); ++i) contents.push_back(maker.latLong(i));
    if (options.byLevel) maker.done();
    for (int face = 0; options.byFace && face < 6; ++face) {
        for (std::size_t i = 0; i < options.levels.size(); ++i) contents.push_back(maker.face(i, face));
        maker.done();
    }
    std::vector<File> files;
    const std::vector<fs::path> names = namesOf(options);
    for (std::size_t i = 0; i < names.size(); ++i) files.push_back({names[i], std::move(contents[i])});
    return files;
}

}  // namespace lumulus::environment
