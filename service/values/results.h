#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/image.h"
#include "base/pass_time.h"
#include "base/tonemap.h"
#include "service/values/requests.h"

/// What the render service answers, as values. A protocol encodes them.
namespace lumulus::service {

/// The photons that pictures of a scene show.
struct PhotonState {
    std::uint64_t firstGeneration = 0;
    int generations = 0;
    int current = 0;  ///< generations that were traced under the light and extinction of now
    std::uint64_t photonsEach = 0;

    std::uint64_t photons() const { return photonsEach * static_cast<std::uint64_t>(generations); }
};

/// A cloud of a scene, as its file says.
struct CloudDescription {
    std::string name;                 ///< its index where the file gives none
    double extinction = 0.0;          ///< 1/m where the density is 1
    std::optional<double> asymmetry;  ///< g of the phase function; absent for those that have none
};

/// The light under which a scene is drawn, and what scatters it.
struct SceneLight {
    glm::dvec3 sunDirection{0.0};           ///< unit vector towards the sun
    glm::dvec3 sunIrradiance{0.0};          ///< W/m² for each colour channel
    std::optional<double> extinction;       ///< 1/m, of the first cloud; absent where the scene has none
    std::vector<scene::FogMedium> media{};  ///< of the fog
};

/// What a scene is: as it was loaded, but for the light, which is that of now.
struct SceneDescription {
    std::string name;
    scene::Image image;
    SceneLight light;
    std::uint64_t seed = 0;
    int generations = 0;  ///< that fill the ring
    std::uint64_t collectors = 0;
    std::string device;
    std::vector<std::string> warnings;
    std::optional<double> asymmetry;               ///< g of the phase function; absent for those that have none
    scene::Sun originalSun;                        ///< as the file says, whatever the light is now
    std::vector<CloudDescription> originalClouds;  ///< as the file says
    std::vector<scene::FogMedium> originalMedia;   ///< the same
    glm::dvec3 centre{0.0};                        ///< metres, of a ball around the clouds
    double radius = 0.0;                           ///< metres
};

/// How far the photons of a scene are.
struct SceneState {
    std::string name;
    PhotonState photons;
    int generationsWanted = 0;
    double traceMilliseconds = 0.0;  ///< of a generation, lately
    SceneLight light;
    bool own = false;           ///< whether the light is the client's own
    std::uint64_t clients = 0;  ///< that are shown the scene, and share its light
};

/// How far the loading of a client's scene is.
struct LoadState {
    std::string step;      ///< as "preparing the cloud"; "waiting" while another scene is loaded
    double seconds = 0.0;  ///< since the load began; 0 while it waits
};

/// A picture of one view. Its size is that of the view; it may have been drawn smaller and enlarged.
struct ViewResult {
    LayeredImage image;
    int drawnWidth = 0, drawnHeight = 0;
};

/// What of the scene a frame shows.
/// How far a picture is too bright (above 0) or too dark in the mean over its clouds and fog, over that mean.
struct Bias {
    double value = 0.0;
    double sigma = 0.0;  ///< standard error of the value
};

struct SceneShown {
    std::string name;
    PhotonState photons;
    double oldestSeconds = 0.0;       ///< since the oldest generation was traced
    std::optional<double> noise;      ///< estimated relMSE of the photons' noise; absent before it is known
    std::optional<Bias> bias = {};    ///< of the first view, measured by paths while it rests
    std::vector<std::string> repeat;  ///< values of `render --set` with which the same picture is drawn
};

/// A drawn frame, before it is encoded.
struct FrameResult {
    SceneShown shown;
    std::vector<ViewResult> views;
    Tone tone;               ///< of the scene, and of a meter where it has one
    bool background = true;  ///< of the scene: whether the colours show the sky
    int reduction = 1;       ///< by which the sides of the pictures were divided
    int sunReduction = 1;    ///< by which the sides of the sun's shadow volume were divided
    double waitedMilliseconds = 0.0;
    double drawMilliseconds = 0.0;
    std::vector<PassTime> passes;  ///< those of photons since the scene's last frame, and those of this frame
};

/// A picture of another renderer as seen through the scene's medium, before it is encoded.
struct CompositeResult {
    std::string scene;
    LayeredImage image;
    Tone tone;  ///< of the scene
    double waitedMilliseconds = 0.0;
};

/// A file that a client has uploaded.
struct StoredUpload {
    std::string hash;  ///< SHA-256, 64 hexadecimal digits
    std::uint64_t bytes = 0;
    double secondsLeft = 0.0;  ///< before it expires, unless it is used
};

struct StreamStopped {
    bool found = false;
};

struct FrameCancelled {
    bool found = false;  ///< whether it still waited
};

struct LightChanged {};

/// What of a file a cloud shows.
struct CloudShown {
    std::string name;
    std::string vdb;             ///< SHA-256 of the upload; empty: `file`
    std::optional<double> file;  ///< number of a sequence's file, with a fraction between two
};

/// Another density is shown.
struct DensityChanged {
    SceneDescription scene;
    std::vector<CloudShown> clouds;  ///< that have another density now
    PhotonState photons;
    bool carried = false;  ///< whether the light of before goes on
};

/// What a query has found: rows of `width` numbers of `channels` values each.
struct QueryAnswer {
    QueryProduct product = QueryProduct::segments;
    int width = 0, height = 1;  ///< passages are one row
    int channels = 6;  ///< transmittance R, G, B; of passages also optical depth R, G, B; of ambient light see protocol
    std::vector<float> values;
};

/// An answer to a request that failed.
struct Failure {
    std::string code, text, where;  ///< as in RequestError
};

using Reply =
    std::variant<SceneDescription, StreamStopped, FrameCancelled, LightChanged, DensityChanged, QueryAnswer, Failure>;

}  // namespace lumulus::service
