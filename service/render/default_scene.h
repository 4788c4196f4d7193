#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <string>
#include <thread>

#include "service/render/scene_source.h"
#include "service/render/scene_store.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

/// Loads the scene that clients see without asking for one, on a thread of its own.
class DefaultScene {
  public:
    struct Host {
        /// Takes the scene. Errors: RequestError. On the thread of the load.
        std::function<void(const SlotPointer&)> loaded;
        /// Takes the error instead: InputError for a bad scene, Error for what fails while it is loaded.
        std::function<void(std::exception_ptr)> failed;
    };

    /// Reads the scene file, and begins to load. `config` and `instruments` must outlive this.
    /// Errors: InputError for a scene file that is not there or is wrong.
    DefaultScene(const RenderConfig& config, Instruments& instruments, Host host);
    DefaultScene(const DefaultScene&) = delete;
    DefaultScene& operator=(const DefaultScene&) = delete;
    /// Gives up the load, and waits for its thread.
    ~DefaultScene();

    /// As SceneSlot::key() of the scene.
    const std::string& key() const { return source_.key; }
    /// Gives up the load: neither function of the host is called any more.
    void abandon() { abandoned_ = true; }

  private:
    void load();

    const RenderConfig& config_;
    Instruments& instruments_;
    Host host_;
    SourcedScene source_;
    std::atomic<bool> abandoned_{false};
    std::thread thread_;
};

}  // namespace lumulus::service
