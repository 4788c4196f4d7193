#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// A client of the Lumulus frame service in one header; link with lumulus_client and crypto. Requests and replies are
/// those of docs/protocol.md; what this header does not name can be asked for as JSON.
namespace lumulus {

/// What the server refuses (`code` is one of docs/protocol.md), and what is wrong with the connection
/// (`code` "connection").
class ClientError : public std::runtime_error {
  public:
    ClientError(std::string errorCode, const std::string& text)
        : std::runtime_error(text), code(std::move(errorCode)) {}
    std::string code;
};

/// One product of a view, as pixels: rows from the top, channels together, little-endian.
struct FrameProduct {
    std::string name;  ///< color (RGBA), cloud (RGBA), transmittance (RGB), depth, front
    int channels = 0;
    std::string type;        ///< half or float
    std::size_t offset = 0;  ///< in the payload
    std::size_t bytes = 0;
};

/// One view: products, or (where it was asked for as exr, png or jpeg) a file.
struct FrameView {
    int width = 0, height = 0;
    std::vector<FrameProduct> products;
    std::string fileType;
    std::size_t offset = 0, bytes = 0;
};

struct Frame {
    std::uint64_t id = 0;
    std::uint64_t photons = 0, firstGeneration = 0;
    int generations = 0;
    bool budgetMet = false;
    int reduction = 1;  ///< by which sides were divided to keep a deadline
    double totalMilliseconds = 0.0;
    std::vector<FrameView> views;
    std::string json;  ///< the whole reply
    std::vector<std::byte> payload;

    /// A product as floats, half floats converted. Errors: ClientError `bad_request` where the view does not have it.
    std::vector<float> values(std::size_t view, const std::string& product) const;
};

/// What a frame shows. What is not set is as in the scene.
struct FrameQuery {
    std::optional<int> width, height;
    std::optional<std::array<double, 3>> position, target, up;  ///< metres
    std::optional<std::array<double, 4>> orientation;           ///< w, x, y, z
    std::optional<double> verticalFov;                          ///< degrees
    std::optional<std::array<double, 4>> frustum;               ///< left, right, bottom, top: tangents
    std::optional<std::array<int, 4>> tile;                     ///< x, y, width, height
    std::optional<std::array<double, 2>> sun;                   ///< azimuth, elevation, degrees
    std::optional<double> milliseconds;                         ///< budget: a deadline
    std::optional<std::uint64_t> photons;                       ///< budget: photons
    std::string encoding = "half";                              ///< half, float, exr, png, jpeg
    std::vector<std::string> products{"color"};
    std::map<std::string, std::string> more;  ///< other fields of the request: name → JSON
};

/// One connection. Not for several threads at once.
class Client {
  public:
    /// "127.0.0.1:7788", "[::1]:7788" or "unix:/run/lumulus/frames.sock". Says hello. `timeout`: seconds that anything
    /// may take. Errors: ClientError.
    explicit Client(const std::string& address, const std::string& token = {}, double timeout = 300.0);
    Client(Client&&) noexcept;
    Client& operator=(Client&&) noexcept;
    ~Client();

    /// The reply to hello, JSON.
    const std::string& welcome() const;

    /// A scene of the server's folder; `fields` are other fields of the request (name → JSON): {"quality",
    /// "\"draft\""}. Returns the reply's JSON.
    std::string loadScene(const std::string& name, const std::map<std::string, std::string>& fields = {});
    /// A scene as TOML.
    std::string loadSceneText(const std::string& toml, const std::map<std::string, std::string>& fields = {});
    /// Sends a VDB file, unless the server has it. Returns its hash, for the field `vdb` of loadScene.
    std::string upload(const std::string& path);

    Frame frame(const FrameQuery& query);
    /// Starts a stream, or changes the wishes of the one with this id. Returns its id.
    std::uint64_t startStream(const FrameQuery& query, std::optional<std::uint64_t> id = std::nullopt);
    /// Waits for the next frame of a stream.
    Frame nextFrame(std::uint64_t stream);
    void stopStream(std::uint64_t stream);

    /// Any request by its type's number: returns the reply's JSON and payload.
    std::pair<std::string, std::vector<std::byte>> request(std::uint16_t type, const std::string& json,
                                                           const std::vector<std::byte>& payload = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lumulus
