#include "job/next_volumes.h"

#include <exception>
#include <utility>

#include "base/progress.h"

namespace lumulus::job {

NextVolumes::~NextVolumes() {
    drop();
}

/// Waits for what is in the making.
void NextVolumes::drop() {
    scene_.reset();
    if (!volumes_.valid()) return;
    try {
        volumes_.get();
    } catch (const std::exception&) {  // nobody wants it
    }
}

void NextVolumes::begin(const scene::Scene& scene) {
    if (scene_ == scene) return;
    drop();
    scene_ = scene;
    // of the caller's scene a copy: it is gone before the thread is done
    volumes_ = std::async(std::launch::async, [scene, check = check_] {
        return loadClouds(scene, noReport, check, FieldStorage::asWanted);
    });
}

bool NextVolumes::take(const scene::Scene& scene, CloudVolumes& volumes) {
    if (!volumes_.valid() || !(scene_ == scene)) return false;
    scene_.reset();
    try {
        volumes = volumes_.get();
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace lumulus::job
