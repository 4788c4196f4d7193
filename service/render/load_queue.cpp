#include "service/render/load_queue.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

namespace lumulus::service {

double loadCost(const scene::Scene& scene) {
    std::set<std::tuple<std::string, std::string, int>> counted;
    double cost = 0.0;
    for (const scene::Cloud& cloud : scene.clouds) {
        const bool file = !cloud.vdb.empty();
        const int resolution = file ? 0 : cloud.resolution;
        if (!counted.emplace(cloud.vdb.string(), file ? cloud.grid : cloud.procedural, resolution).second) continue;
        std::error_code ec;
        const std::uintmax_t bytes = file ? std::filesystem::file_size(cloud.vdb, ec) : 0;
        if (!ec) cost += static_cast<double>(bytes) + std::pow(resolution, 3.0);
    }
    return cost;
}

std::optional<LoadQueue::Entry> LoadQueue::take(std::span<const Running> running, const std::string& held,
                                                Clock::time_point now) {
    constexpr auto longestWait = std::chrono::seconds(10);
    const bool largeRuns = std::ranges::any_of(running, &Running::large);
    std::set<ClientId> busy;  // clients of which nothing may begin
    for (const Running& one : running) busy.insert(one.client);
    const auto rank = [&](const Entry& entry) {
        if (!entry.source) return std::tuple(0, 0.0, entry.since);
        const bool late = now - entry.since > longestWait;
        return std::tuple(late ? 1 : 2, late ? 0.0 : entry.cost, entry.since);
    };
    auto best = entries_.end();
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
        if (!busy.insert(entry->job.client).second) continue;
        if (entry->source) {
            const std::string& key = entry->source->key;
            if (key == held || std::ranges::find(running, key, &Running::key) != running.end()) continue;
            if (entry->large() && largeRuns) continue;
        }
        if (best == entries_.end() || rank(*entry) < rank(*best)) best = entry;
    }
    if (best == entries_.end()) return std::nullopt;
    Entry taken = std::move(*best);
    entries_.erase(best);
    return taken;
}

std::size_t LoadQueue::count(ClientId client) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        entries_, [client](const Entry& entry) { return entry.job.client == client && !entry.job.density; }));
}

std::vector<LoadJob> LoadQueue::takeDensities(ClientId client, std::optional<std::uint64_t> id) {
    std::vector<LoadJob> taken;
    std::erase_if(entries_, [&](Entry& entry) {
        if (entry.job.client != client || !entry.job.density || (id && entry.job.id != *id)) return false;
        taken.push_back(std::move(entry.job));
        return true;
    });
    return taken;
}

void LoadQueue::removeClient(ClientId client) {
    std::erase_if(entries_, [&](const Entry& entry) { return entry.job.client == client; });
}

std::vector<LoadJob> LoadQueue::takeAll() {
    std::vector<LoadJob> jobs;
    for (Entry& entry : std::exchange(entries_, {})) jobs.push_back(std::move(entry.job));
    return jobs;
}

}  // namespace lumulus::service
