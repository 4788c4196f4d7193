#include "job/next_volumes.h"

#include <exception>
#include <utility>

#include "base/progress.h"

namespace lumulus::job {

NextVolumes::~NextVolumes() {
    wait();
}

/// Waits for what is in the making.
void NextVolumes::wait() {
    scene_.reset();
    if (!volumes_.valid()) return;
    try {
        volumes_.get();
    } catch (const std::exception&) {  // nobody wants it
    }
}

void NextVolumes::drop() {
    wait();
    known_ = {};
}

CloudVolumes NextVolumes::read(const scene::Scene& scene) {
    return loadClouds(scene, noReport, check_, FieldStorage::asWanted, &known_);
}

void NextVolumes::begin(const scene::Scene& scene) {
    if (scene_ == scene) return;
    wait();
    scene_ = scene;
    // of the caller's scene a copy: it is gone before the thread is done
    volumes_ = std::async(std::launch::async, [this, scene] { return read(scene); });
}

CloudVolumes NextVolumes::take(const scene::Scene& scene) {
    if (!volumes_.valid() || !(scene_ == scene)) {
        wait();
        return read(scene);
    }
    scene_.reset();
    return volumes_.get();
}

}  // namespace lumulus::job
