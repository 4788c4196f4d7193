#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "service/values/requests.h"

namespace lumulus::service {

struct RenderLimits {
    std::uint32_t queuedFrames = 8;  ///< of one client, besides those of which only the newest of a channel waits
    std::uint32_t streams = 16;      ///< of one client
    std::uint32_t unsentFrames = 2;  ///< to one client, before it gets no more
    std::uint32_t scenes = 3;        ///< held in memory at once
    std::uint32_t ownLights = 8;     ///< of clients that change the light of a scene which others see too
    double sceneMemory = 2048.0;     ///< MiB for density and for photons of one scene
    std::uint64_t photonsPerGeneration = 4'000'000;
    double generationSeconds = 30.0;  ///< for one generation or one picture; a scene that takes longer is dropped
    double loadSeconds = 120.0;       ///< for loading a scene
    double reloadSeconds = 60.0;      ///< that the default scene must have lasted to be loaded again after it failed
    double shutdownSeconds = 5.0;     ///< for frames that wait when the service ends
    double heartbeatSeconds = 10.0;   ///< for a step of the render thread, before the service counts as stuck
    double uploadHours = 168.0;       ///< for which an upload is kept that nobody uses
    std::uint64_t uploadFolderBytes = std::uint64_t{8} << 30U;
    std::uint64_t uploadClientBytes = std::uint64_t{2} << 30U;  ///< of one client's uploads
    std::uint64_t memoryBytes = std::uint64_t{4} << 30U;        ///< that clients may make the process hold
    RequestLimits requests;
};

/// Which scenes are served, and how.
struct RenderConfig {
    std::filesystem::path scenes;   ///< folder of scene files
    std::filesystem::path uploads;  ///< folder, made where it does not exist
    std::string defaultScene;       ///< name in `scenes`; empty: clients load one
    std::string quality;            ///< of the default scene: "", draft, interactive or final
    bool sharedLight = false;       ///< whether a client changes the light of all who see the scene
    std::string device;             ///< name (part of it) or index of the Vulkan device; empty: the best one
    RenderLimits limits;
};

}  // namespace lumulus::service
