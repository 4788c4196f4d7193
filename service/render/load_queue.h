#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "service/render/density_source.h"
#include "service/render/scene_source.h"
#include "service/render/scheduler.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// A scene that a client asks for, or one that it sees with another density.
struct LoadJob {
    ClientId client = 0;
    std::uint64_t id = 0;
    LoadScene load;
    std::shared_ptr<MemoryBudget::Share> memory = {};  ///< that the request holds
    std::shared_ptr<const DensityWish> density = {};   ///< null: a scene
};

/// What loading a scene costs, in voxels: those of procedural clouds, and a voxel for each byte of a file.
double loadCost(const scene::Scene& scene);

/// Scenes that wait to be loaded, and which comes next: the one that costs the least. Those of one client come one at a
/// time and in their order. Large ones come one at a time too, so that they leave loaders to small ones.
class LoadQueue {
  public:
    static constexpr double largeCost = 128.0 * 128.0 * 128.0;  ///< what costs more is large

    struct Entry {
        LoadJob job;
        Clock::time_point since = {};                     ///< when it began to wait
        std::shared_ptr<const SourcedScene> source = {};  ///< null while nobody has looked
        double cost = 0.0;                                ///< of the source
        bool large() const { return cost > largeCost; }
    };
    /// A load that is under way.
    struct Running {
        ClientId client = 0;
        std::string key;  ///< of its scene; empty while that is looked for
        bool large = false;
    };

    void push(LoadJob job, Clock::time_point now) { entries_.push_back({std::move(job), now}); }
    /// Takes an entry back whose source is known now, before all others of its client.
    void putBack(Entry entry) { entries_.push_front(std::move(entry)); }
    /// What begins next beside those that run: one whose source is to be found, else the cheapest, else none. What has
    /// waited for ten seconds goes before what is cheap. `held` is the key of a scene that nobody is to load.
    std::optional<Entry> take(std::span<const Running> running, const std::string& held, Clock::time_point now);

    /// Scenes, without densities.
    std::size_t count(ClientId client) const;
    void removeClient(ClientId client);
    /// Takes the densities that a client waits for, or that of one request.
    std::vector<LoadJob> takeDensities(ClientId client, std::optional<std::uint64_t> id);
    std::vector<LoadJob> takeAll();

  private:
    std::deque<Entry> entries_;
};

}  // namespace lumulus::service
