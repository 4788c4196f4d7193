#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/quality.h"
#include "view/view.h"

/// What clients ask of the scenes that are served, as values that no protocol owns. Where a field is absent,
/// docs/protocol.md says what stands in its place.
namespace lumulus::service {

using ClientId = std::uint64_t;
using Clock = std::chrono::steady_clock;

struct LoadScene {
    std::string name;  ///< in the folder of scenes; empty: `toml`
    std::string toml;
    std::string vdb;  ///< SHA-256 (64 hexadecimal digits) of an upload that takes the place of the scene's cloud
    std::vector<std::string> overrides;
    std::optional<scene::Quality> quality;
    bool isPrivate = false;  ///< photons and light of its own
};

/// A piece of a file.
struct Upload {
    std::string hash;  ///< SHA-256 of the whole file, 64 hexadecimal digits
    std::uint64_t size = 0;
    std::uint64_t offset = 0;
    std::vector<std::byte> bytes;
};

/// A change of light, medium or wind. Photons traced before it give way to new ones generation by generation.
struct LightChange {
    std::optional<glm::dvec3> sunDirection;   ///< unit vector towards the sun
    std::optional<glm::dvec3> sunIrradiance;  ///< W/m² for each colour channel
    std::optional<double> extinction;         ///< 1/m where the density is 1
    std::optional<glm::dvec3> wind;           ///< m/s, by which the cloud drifts with the time of frames

    std::optional<glm::dvec3> move;  ///< metres by which a cloud lies from where the scene has it

    bool empty() const { return !sunDirection && !sunIrradiance && !extinction && !wind && !move; }
};

/// A cloud of the scene, by its index or by its name.
using CloudReference = std::variant<std::uint32_t, std::string>;

struct CameraRequest {
    std::optional<glm::dvec3> position, target, up;
    std::optional<glm::dquat> orientation;
    std::optional<double> verticalFov;  ///< degrees
    std::optional<Frustum> frustum;
    std::optional<scene::Projection> projection;
};

struct ViewRequest {
    CameraRequest camera;
    std::optional<int> width, height;
    std::optional<Tile> tile;
};

enum class Product { color, cloud, transmittance, depth, front };
enum class Encoding { half, raw, exr, png, jpeg };
inline constexpr std::size_t encodings = 5;

/// In which form a picture is sent.
struct PictureFormat {
    Encoding encoding = Encoding::half;
    int quality = 85;                ///< of JPEG, 1 to 100
    std::optional<double> exposure;  ///< stops, for PNG and JPEG; absent: the scene's
    bool hash = true;                ///< whether the reply holds the payload's SHA-256
};

/// What a frame may cost. Without either: all generations that the scene asks for.
struct Budget {
    std::optional<double> milliseconds;
    std::optional<std::uint64_t> photons;
};

struct FrameRequest {
    std::uint32_t channel = 0;
    bool queue = false;              ///< wait behind the frames of the channel instead of taking their place
    std::vector<ViewRequest> views;  ///< at least one
    double time = 0.0;               ///< seconds, for the wind
    LightChange light;
    Budget budget;
    std::vector<Product> products{Product::color};
    PictureFormat format;
};

/// Moments at which the frames of a stream are due, counted from the request.
struct Rhythm {
    double every = 0.0;  ///< milliseconds between them, above 0
    double phase = 0.0;  ///< milliseconds from the request to the first
};

struct StartStream {
    FrameRequest frame;
    double maxRate = 30.0;         ///< frames a second, without a rhythm
    std::optional<Rhythm> rhythm;  ///< absent: a frame that comes late moves those after it
    bool onChange = false;         ///< only frames that differ from the one before
};

struct StopStream {
    std::uint64_t stream = 0;
};

/// Colour and depth of another renderer, to be seen through the scene's medium.
struct Composite {
    int width = 0, height = 0;
    CameraRequest camera;
    PictureFormat format;
    /// Floats, little-endian: RGB pixel by pixel, then the depth of each pixel, in metres from the eye unless the
    /// scene's `fog.depth` says otherwise. Not looked at yet: there may be many.
    std::vector<std::byte> pixels;
};

struct Cancel {
    std::uint64_t request = 0;
};

/// A change of one cloud of a scene.
struct CloudEdit {
    enum class Kind {
        add,     ///< another cloud of the density of `cloud`
        remove,  ///< the cloud goes
        alter,   ///< the cloud becomes another
    };
    Kind kind = Kind::alter;
    CloudReference cloud;
    std::string name;  ///< of the cloud that is added
    // in what it differs:
    std::optional<glm::dvec3> move;    ///< metres from where the scene has `cloud`
    std::optional<double> extinction;  ///< 1/m where the density is 1
    std::optional<glm::dvec3> albedo;  ///< of each colour channel
    std::optional<double> asymmetry;   ///< g of a phase function of Henyey and Greenstein
    double yaw = 0.0;                  ///< of one that is added, in degrees, anticlockwise as seen from above
    double scale = 1.0;                ///< of one that is added
};

/// Another density for a cloud of the scene, or for all clouds that show files of a sequence.
struct NewDensity {
    std::string vdb;              ///< SHA-256 (64 hexadecimal digits) of an upload; empty: `frame`
    std::string grid;             ///< of the file; empty: as the scene has it
    std::optional<double> frame;  ///< of the scene, whose file the cloud shows
    double seconds = 0.0;         ///< by which an upload is later than what is shown; 0: nothing is known of motion
};

/// A change of a medium of the scene's fog.
struct MediumEdit {
    std::uint32_t medium = 0;                 ///< its index in the scene
    bool original = false;                    ///< it becomes what the scene's file says, but for `keys`
    std::map<std::string, std::string> keys;  ///< of [[fog.media]], with their values in TOML
};

struct Change {
    LightChange light;
    std::optional<CloudReference> cloud;  ///< whose extinction changes; absent: all clouds
    std::vector<CloudEdit> edits;         ///< one after the other; all of them or none
    std::optional<NewDensity> density;    ///< of `cloud`
    std::vector<MediumEdit> media;        ///< of different media; all of them or none
};

enum class QueryProduct { segments, sun, groundShadow, ambient };

/// Points of which one query may ask for the ambient light: each costs a small picture.
inline constexpr std::size_t mostAmbientPoints = 64;

/// Ways that one query may ask about.
inline constexpr std::size_t mostQueryWays = 262144;

/// A question about transmittance, without a picture.
struct QueryRequest {
    QueryProduct product = QueryProduct::segments;
    std::vector<double> numbers;    ///< metres: segments x0, y0, z0, x1, y1, z1; points x, y, z
    std::vector<double> rectangle;  ///< of a ground shadow: x0, z0, x1, z1 [m]
    std::optional<double> y;        ///< its height [m]; absent: that of the ground, or 0
    int width = 256, height = 256;  ///< its pixels
};

/// Requests that the render service answers.
using RenderRequest =
    std::variant<LoadScene, FrameRequest, StartStream, StopStream, Composite, Cancel, Change, QueryRequest>;

/// Limits of requests, from the configuration.
struct RequestLimits {
    std::uint64_t pixels = 1U << 23U;  ///< of all views of a frame together
    std::uint32_t views = 16;
    std::uint64_t uploadBytes = std::uint64_t{1} << 30U;
};

}  // namespace lumulus::service
