#include "service/render/bias_desk.h"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <exception>
#include <map>
#include <utility>

#include "reference/picture_error.h"

namespace lumulus::service {

namespace {

constexpr double seconds = 3.0;
constexpr int lowPriority = 10;  // niceness: frames go first

/// Thrown where nobody waits any more.
struct GivenUp {};

/// The clouds of the scene as paths have them. None where a field has coarse bricks.
std::optional<std::vector<vdb::PlacedVolume>> volumesOf(const std::vector<query::CloudField>& fields,
                                                        std::map<const query::BrickField*, vdb::Volume>& known,
                                                        const Check& check) {
    std::vector<vdb::PlacedVolume> placed;
    for (const query::CloudField& cloud : fields) {
        const query::BrickField* field = cloud.placed.field.get();
        if (!known.contains(field)) {
            std::optional<vdb::Volume> volume = field->volume(check);
            if (!volume) return std::nullopt;
            known.emplace(field, std::move(*volume));
        }
        placed.emplace_back(known.at(field), vdb::Affine{cloud.placed.voxelToMetres, cloud.placed.origin});
    }
    return placed;
}

std::optional<Bias> biasOf(BiasJob job, const Check& check) {
    std::map<const query::BrickField*, vdb::Volume> known;
    const auto volumes = volumesOf(job.fields, known, check);
    if (!volumes) return std::nullopt;
    std::vector<scene::Cloud> clouds;
    for (const query::CloudField& cloud : job.fields) {
        clouds.push_back(job.scene.clouds.at(cloud.cloud));
        clouds.back().extinction = cloud.placed.extinction;  // of densities that are at most 1
    }
    job.scene.clouds = std::move(clouds);
    const reference::PixelPaths paths(job.scene, *volumes, makeCamera(job.view, boundsOf(*volumes)), job.view.image);
    check();
    const auto probes = reference::ErrorProbes::trace(job.picture, paths, {job.scene.photonMap.seed, seconds, 0},
                                                      [&](double) { check(); });
    if (!probes) return std::nullopt;
    const reference::PictureError error = probes->errorOf(job.picture);
    return Bias{error.bias, error.biasSigma};
}

}  // namespace

BiasDesk::BiasDesk(std::function<void()> told) : told_(std::move(told)), thread_([this] { loop(); }) {}

void BiasDesk::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

bool BiasDesk::isFree() const {
    const std::lock_guard lock(mutex_);
    return !working_ && !waiting_ && !found_;
}

void BiasDesk::hand(BiasJob job) {
    {
        const std::lock_guard lock(mutex_);
        waiting_ = std::move(job);
    }
    wake_.notify_all();
}

std::optional<BiasDesk::Found> BiasDesk::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(found_, std::nullopt);
}

void BiasDesk::loop() {
    setpriority(PRIO_PROCESS, 0, lowPriority);  // on Linux that of this thread
    tbb::task_arena alone(1);                   // the other threads are the frames'
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stopping_ || waiting_; });
        if (stopping_) return;
        BiasJob job = std::move(*std::exchange(waiting_, std::nullopt));
        working_ = true;
        lock.unlock();
        Found found{job.slot, job.revision, {}};
        const Check check = [this, old = job.old] {
            if (stopping_ || *old) throw GivenUp{};
        };
        try {
            alone.execute([&] { found.bias = biasOf(std::move(job), check); });
        } catch (const GivenUp&) {
        } catch (const std::exception&) {  // paths cannot tell
        }
        lock.lock();
        working_ = false;
        found_ = std::move(found);
        lock.unlock();
        told_();
        lock.lock();
    }
}

}  // namespace lumulus::service
