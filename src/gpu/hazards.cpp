#include "gpu/hazards.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lumulus::gpu {

void HazardTracker::use(const std::string& command, std::span<const Access> accesses) {
    for (const Access& access : accesses) {
        const auto found = users_.find(access.resource);
        if (found == users_.end()) continue;
        const Users& users = found->second;
        const bool afterWrite = !users.writer.empty() && (access.reads || access.writes);
        const bool afterRead = !users.reader.empty() && access.writes;
        if (afterWrite || afterRead)
            throw std::logic_error(fmt::format(
                "missing barrier: {} {} {} {} by {}", command, access.reads && afterWrite ? "reads" : "writes",
                access.name, afterWrite ? "written" : "read", afterWrite ? users.writer : users.reader));
    }
    // only now, so that a command may use one resource twice
    for (const Access& access : accesses) {
        Users& users = users_[access.resource];
        if (access.reads) users.reader = command;
        if (access.writes) users.writer = command;
    }
}

}  // namespace lumulus::gpu
