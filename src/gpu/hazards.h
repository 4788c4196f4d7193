#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>

namespace lumulus::gpu {

/// What one command does to one resource.
struct Access {
    std::uint64_t resource = 0;
    std::string name;
    bool reads = false;
    bool writes = false;
};

/// Remembers who read and wrote each resource since the last barrier. Resources count as wholes, not by ranges.
/// It finds what synchronisation validation misses: two dispatches that write the same buffer, atomics included.
class HazardTracker {
  public:
    /// Throws std::logic_error "missing barrier: <command> reads <resource> written by <other>" and the like.
    void use(const std::string& command, std::span<const Access> accesses) {
        for (const Access& access : accesses) {
            const Users& users = users_[access.resource];
            const std::string use =
                "missing barrier: " + command + (access.reads ? " reads " : " writes ") + access.name;
            if (!users.writer.empty()) throw std::logic_error(use + " written by " + users.writer);
            if (access.writes && !users.reader.empty()) throw std::logic_error(use + " read by " + users.reader);
        }
        // only now, so that a command may use one resource twice
        for (const Access& access : accesses) {
            Users& users = users_[access.resource];
            if (access.reads) users.reader = command;
            if (access.writes) users.writer = command;
        }
    }
    void barrier() { users_.clear(); }

  private:
    struct Users {
        std::string reader;
        std::string writer;
    };
    std::map<std::uint64_t, Users> users_;
};

}  // namespace lumulus::gpu
