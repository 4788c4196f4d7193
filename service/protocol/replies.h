#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/protocol/encode.h"
#include "service/protocol/message.h"
#include "service/values/results.h"

namespace lumulus::service {

/// What a client is told in the reply to hello.
struct Welcome {
    std::string scene;    ///< that is there without loading; empty: none
    std::string quality;  ///< of that scene
    MessageLimits messages;
    RequestLimits requests;
    std::uint32_t streams = 0, queuedFrames = 0;
    bool sharedLight = false;  ///< whether a client changes the light of all who see the scene
};

/// JSON of the reply to hello.
std::string welcomeText(const Welcome& welcome);

/// The message that tells a result.
Message encodeReply(std::uint64_t id, const Reply& reply);

/// The reply to `statistics`: counters by name, what the client's scene is up to, and how far the load of its next one
/// is.
Message statisticsReply(std::uint64_t id, const std::vector<std::pair<std::string_view, std::int64_t>>& counters,
                        const std::optional<SceneState>& scene, const std::optional<LoadState>& loading = {});

/// The reply to `list_scenes`. `names` are UTF-8.
Message scenesReply(std::uint64_t id, const std::vector<std::string>& names);

/// The reply to a chunk of an upload.
Message uploadReply(std::uint64_t id, std::uint64_t received, bool complete);

/// The reply to `list_uploads`; `mostBytes` that they may hold.
Message uploadsReply(std::uint64_t id, const std::vector<StoredUpload>& uploads, std::uint64_t mostBytes);

/// The reply to `delete_upload`.
Message uploadDeletedReply(std::uint64_t id, bool found);

/// Which frame a reply is.
struct FrameMark {
    std::uint64_t id = 0;  ///< of the request
    bool stream = false;
    std::uint64_t number = 0;  ///< of the frame in its stream
};

/// Milliseconds of a frame that are known when it is encoded.
struct FrameTimes {
    double encode = 0.0;
    double total = 0.0;  ///< from the arrival of the request
};

/// Whether a frame kept its budget.
bool budgetMet(const Budget& budget, const FrameResult& result, double totalMilliseconds);

Message frameReply(const FrameMark& mark, const FrameRequest& request, const FrameResult& result,
                   EncodedPictures pictures, const FrameTimes& times);
Message compositeReply(std::uint64_t id, const Composite& request, const CompositeResult& result,
                       EncodedPictures pictures, const FrameTimes& times);

}  // namespace lumulus::service
