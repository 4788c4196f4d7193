#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "draw/picture_view.h"
#include "scene/quality.h"
#include "service/protocol/message.h"

namespace lumulus::service {

/// What clients may ask for, as values. Where a field is absent, docs/protocol.md says what stands in its place.

struct Hello {
    std::string token;
    std::string client;  ///< a name for the log
};

struct LoadScene {
    std::string name;  ///< in the folder of scenes; empty: `toml`
    std::string toml;
    std::string vdb;  ///< SHA-256 of an upload that takes the place of the scene's cloud
    std::vector<std::string> overrides;
    std::optional<scene::Quality> quality;
    bool isPrivate = false;  ///< photons and light of its own
};

struct Upload {
    std::string hash;  ///< SHA-256 of the whole file, 64 hexadecimal digits
    std::uint64_t size = 0;
    std::uint64_t offset = 0;
    std::vector<std::byte> bytes;
};

/// A change of the scene that ages in.
struct LightChange {
    std::optional<glm::dvec3> sunDirection;  ///< unit vector towards the sun
    std::optional<glm::dvec3> sunIrradiance;
    std::optional<double> extinction;
    std::optional<glm::dvec3> wind;  ///< m/s, by which the cloud drifts with the time of frames

    bool empty() const { return !sunDirection && !sunIrradiance && !extinction && !wind; }
};

struct CameraRequest {
    std::optional<glm::dvec3> position, target, up;
    std::optional<glm::dquat> orientation;
    std::optional<double> verticalFov;
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
    Encoding encoding = Encoding::half;
    int quality = 85;                ///< of JPEG
    std::optional<double> exposure;  ///< stops, for PNG and JPEG
    bool hash = true;                ///< of the payload, in the reply
};

struct StartStream {
    FrameRequest frame;
    double maxRate = 30.0;  ///< frames a second
    bool onChange = false;  ///< only frames that differ from the one before
};

struct StopStream {
    std::uint64_t stream = 0;
};

/// Colour and depth of another renderer, to be seen through the scene's medium.
struct Composite {
    int width = 0, height = 0;
    CameraRequest camera;
    Encoding encoding = Encoding::half;
    int quality = 85;
    std::optional<double> exposure;
    bool hash = true;
    std::vector<float> color;  ///< RGB, pixel by pixel
    std::vector<float> depth;  ///< metres from the eye
};

struct Cancel {
    std::uint64_t request = 0;
};

struct StatisticsRequest {};
struct Ping {};

struct Change {
    LightChange light;
};

using Request = std::variant<Hello, LoadScene, Upload, FrameRequest, StartStream, StopStream, Composite, Cancel,
                             StatisticsRequest, Ping, Change>;

/// What requests may be, from the configuration.
struct RequestLimits {
    std::uint64_t pixels = 1U << 23U;  ///< of all views of a frame together
    std::uint32_t views = 16;
    std::uint64_t uploadBytes = std::uint64_t{1} << 30U;
};

/// Errors: RequestError `bad_request` (the field is named), `too_large`, `unknown_type`.
Request parseRequest(Message message, const RequestLimits& limits);

/// SHA-256 in text: 64 digits 0-9 a-f.
bool isHash(const std::string& text);

}  // namespace lumulus::service
