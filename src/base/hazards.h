#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace lumulus {

/// What one command does to one resource, or to one mip level of an image.
struct Access {
    std::uint64_t resource = 0;
    std::string name;
    bool reads = false;
    bool writes = false;
    std::uint32_t level = 0;  ///< a command that uses several levels has an access for each
};

/// Remembers who read and wrote each resource since the last barrier. Buffers count as wholes, images by mip level with
/// all layers: a command may read one level and write the next, and no other may read that before a barrier.
/// It finds what synchronisation validation misses: two dispatches that write the same buffer, atomics included.
class HazardTracker {
  public:
    /// Throws std::logic_error "missing barrier: <command> reads <resource> written by <other>" and the like.
    void use(const std::string& command, std::span<const Access> accesses) {
        for (const Access& access : accesses) {
            const Users& users = users_[{access.resource, access.level}];
            const std::string use =
                "missing barrier: " + command + (access.reads ? " reads " : " writes ") + access.name;
            if (!users.writer.empty()) throw std::logic_error(use + " written by " + users.writer);
            if (access.writes && !users.reader.empty()) throw std::logic_error(use + " read by " + users.reader);
        }
        // only now, so that a command may use one resource twice
        for (const Access& access : accesses) {
            Users& users = users_[{access.resource, access.level}];
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
    std::map<std::pair<std::uint64_t, std::uint32_t>, Users> users_;  ///< by resource and level
};

}  // namespace lumulus
