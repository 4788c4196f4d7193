#include "service/render/default_scene.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

std::optional<scene::Quality> qualityOf(const std::string& name) {
    if (name.empty()) return std::nullopt;
    return name == "draft" ? scene::Quality::draft
                           : (name == "final" ? scene::Quality::final : scene::Quality::interactive);
}

InputError badScene(const std::exception& e, const RenderConfig& config) {
    return {std::string("the default scene: ") + e.what(), config.defaultScene, "change scenes.default"};
}

SourcedScene sourced(const RenderConfig& config) {
    LoadScene load;
    load.name = config.defaultScene;
    load.quality = qualityOf(config.quality);
    try {
        return sourceScene(load, config, 0);
    } catch (const RequestError& e) {
        throw badScene(e, config);
    }
}

}  // namespace

DefaultScene::DefaultScene(const RenderConfig& config, Instruments& instruments, Host host)
    : config_(config), instruments_(instruments), host_(std::move(host)), source_(sourced(config)), thread_([this] {
          load();
      }) {}

DefaultScene::~DefaultScene() {
    abandon();
    thread_.join();
}

void DefaultScene::load() {
    instruments_.log.event("info", "scene_loading", {{"scene", source_.scene.source}});
    const auto start = Clock::now();
    try {
        const auto slot = std::make_shared<SceneSlot>(
            source_, config_,
            [this] {
                if (abandoned_) throw Cancelled{};
            },
            nullptr);
        if (abandoned_) return;
        host_.loaded(slot);
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        instruments_.log.event("info", "scene_loaded", {{"scene", source_.scene.source}, {"seconds", seconds}});
    } catch (const Cancelled&) {
        return;
    } catch (const std::exception& e) {
        if (!abandoned_) host_.failed(std::make_exception_ptr(badScene(e, config_)));
    }
}

}  // namespace lumulus::service
