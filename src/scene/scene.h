#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/field.h"
#include "scene/fog.h"
#include "scene/lamp.h"
#include "scene/mesh.h"
#include "scene/phase.h"
#include "scene/sky.h"
#include "scene/surface.h"
#include "scene/voxels.h"
#include "scene/wind.h"

/// The scene as values: the keys of the file, with every default filled in and every value checked.
/// Units: metres, degrees (angles of the file), W·m⁻² and W·m⁻²·sr⁻¹ per channel, 1/m.
namespace lumulus::scene {

/// What sets the exposure of PNG files and of encoded frames.
enum class ExposureMode { stops, ev100, automatic };
enum class ToneMap { filmic, agx, aces, neutral, linear };

struct Image {
    int width = 1280;
    int height = 720;
    double exposure = 0.0;  ///< photographic stops, applied before the tone map of PNG files only
    ExposureMode exposureMode = ExposureMode::stops;
    double ev100 = 15.0;  ///< exposure value at ISO 100, for `ev100`
    ToneMap toneMap = ToneMap::filmic;
    bool background = true;  ///< whether R, G, B show the sky and the sun's disc, and A is 1 where they do

    bool operator==(const Image&) const = default;
};

enum class Projection { perspective, orthographic, panorama };

struct Camera {
    std::optional<glm::dvec3> position;  ///< absent: placed so that the clouds fill the picture
    std::optional<glm::dvec3> target;    ///< absent: the middle of the clouds
    glm::dvec3 up{0.0, 1.0, 0.0};
    double verticalFov = 40.0;  ///< degrees; of an orthographic camera: frames the same height at the target
    Projection projection = Projection::perspective;

    bool operator==(const Camera&) const = default;
};

/// What a cloud shows before the first and behind the last file of its sequence.
enum class Extend { hold, repeat, pingPong, clip };

/// The files of a cloud that is another one from frame to frame.
struct FileSequence {
    std::optional<glm::i64vec2> frames;  ///< first and last file; none: whatever there is
    double fps = 0.0;                    ///< files a second; 0: as many as frames
    double offset = 0.0, speed = 1.0;    ///< file = first + offset + speed · fps · seconds since the first one
    Extend extend = Extend::hold;
    bool holdMissing = false;  ///< whether the file before stands for one that is missing
    bool interpolate = true;   ///< whether moments between two files show both, moved along their motion

    bool operator==(const FileSequence&) const = default;
};

/// What of its sequence a cloud shows at a frame.
struct SequenceMoment {
    std::filesystem::path name;  ///< of the files, with the place for their number
    double file = 0.0;           ///< number of the file that is shown; between two of them where `next` is
    double fps = 24.0;           ///< files a second
    std::filesystem::path next;  ///< file behind that of the cloud, where the moment lies between both; else empty

    /// Of the way from the file to the next one, 0 to 1.
    double share() const { return file - std::floor(file); }
    bool operator==(const SequenceMoment&) const = default;
};

struct Cloud {
    std::string name;                      ///< empty: its index, see nameOf
    std::filesystem::path vdb;             ///< empty: procedural
    std::shared_ptr<const Voxels> voxels;  ///< in place of both; shared by copies of the scene, since it may be large
    std::string grid;                      ///< any case, `density[1]` for the second; empty: chosen by the names of all
    FileSequence sequence;                 ///< where the file's name has a place for a number
    std::optional<SequenceMoment> moment;  ///< of a sequence: what of it is shown
    std::optional<Wind> velocity;          ///< of what is in the files, where they do not tell; by their own heights
    std::string held;                      ///< the file that is missing, where the one before it stands for it
    bool clamp = false;                    ///< values of the grid that are no densities become 0
    std::optional<std::array<glm::ivec3, 2>> part;  ///< first and last voxel of the grid that it shows; none: all
    std::string procedural = "cumulus";
    int resolution = 192;  ///< voxels along the longest side of a procedural cloud
    std::uint64_t seed = 1;
    glm::dmat4 transform{1.0};        ///< applied after the grid's own transform
    std::filesystem::path instances;  ///< CSV of places; empty: one instance, at `transform`
    double densityScale = 1.0;
    double extinction = 0.08;  ///< σt = extinction · density_scale · value [1/m]
    glm::dvec3 albedo{1.0};
    Phase phase;

    bool operator==(const Cloud&) const = default;
};

/// How a density field lies in memory: every voxel of its box, or bricks of 8³ voxels where there is density.
enum class DensityStorage { automatic, dense, sparse };

struct Preparation {
    int samples = 20000;
    double densityThreshold = 0.1;          ///< share of the maximum: a leaf with a smaller range is not split
    std::optional<double> influenceRadius;  ///< metres; absent: from the mean distance of samples
    int maxLeaves = 32768;
    double memoryBudget = 512.0;  ///< MiB for the density volumes of all clouds on the GPU
    DensityStorage storage = DensityStorage::automatic;
    bool levelOfDetail = true;  ///< whether clouds that are small in the picture have fewer collectors and photons

    bool operator==(const Preparation&) const = default;
};

enum class Majorant { automatic, local, global };

struct PhotonMap {
    std::int64_t photons = 2000000;  ///< in the whole ring
    int generations = 20;
    std::int64_t firstGeneration = 0;
    int bands = 4;
    double forwardCut = 15.0;  ///< degrees; 0 = off
    Majorant majorant = Majorant::automatic;
    double memoryBudget = 1024.0;  ///< MiB on the GPU for the light of collectors
    std::uint64_t seed = 1;
    bool separateLights = false;  ///< whether the light of sun and of sky are kept apart
    bool transfer = false;        ///< whether frames of a sequence go on with the light of those before
    int transferFrames = 0;       ///< frames that the light of a frame is the mean of; 0: by what is known of motion
    /// Whether the scene names them: otherwise clouds of flat voxels have their own (cloud/refined.h).
    bool directionsGiven = false;  ///< bands or forward cut
    bool photonsGiven = false;

    bool operator==(const PhotonMap&) const = default;
};

/// Frames at most that the light of a frame is the mean of.
inline int mostFrames(const PhotonMap& map) {
    constexpr int known = 8;  // where the motion is known, docs/experiments/transfer.md
    if (!map.transfer) return 1;
    return map.transferFrames > 0 ? map.transferFrames : known;
}

enum class DrawMode { march, billboards };

struct Draw {
    DrawMode mode = DrawMode::march;
    double tolerance = 0.2;  ///< relative error of interpolated pixels; 0: every pixel is drawn

    bool operator==(const Draw&) const = default;
};

struct Scene {
    Image image;
    Camera camera;
    Sun sun;
    Moon moon;
    Sky sky;
    std::optional<Time> time;      ///< absent: the sun stands where `sun` says
    std::optional<Ground> ground;  ///< absent: nothing is below the clouds
    std::vector<Cloud> clouds;
    std::vector<Field> fields;
    Preparation preparation;
    PhotonMap photonMap;
    Draw draw;
    Fog fog;
    std::vector<Surface> surfaces;
    std::vector<Lamp> lamps;
    std::vector<Mesh> meshes;
    std::string source;    ///< file name, for messages and the EXR header
    double seconds = 0.0;  ///< time of the frame: fields have been carried by their wind so long

    bool operator==(const Scene&) const = default;
};

/// The name of a cloud of the scene: the one that the scene gives it, or else its index.
inline std::string nameOf(const Scene& scene, std::size_t cloud) {
    const std::string& name = scene.clouds.at(cloud).name;
    return name.empty() ? std::to_string(cloud) : name;
}

}  // namespace lumulus::scene
