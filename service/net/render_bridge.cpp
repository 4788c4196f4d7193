#include "service/net/render_bridge.h"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>

#include "service/protocol/error_reply.h"
#include "service/protocol/replies.h"

namespace lumulus::service {

namespace {

unsigned encoderThreads() {
    const std::size_t most = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::max(1U, std::min(std::thread::hardware_concurrency(), static_cast<unsigned>(most)));
}

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void stopIfCancelled(const Job& job) {
    if (job.cancelled->load()) throw Cancelled{};
}

Tone shownOn(Tone tone, const std::optional<DisplayTransform>& display) {
    tone.display = display ? &*display : nullptr;
    return tone;
}

EncodedPictures picturesOf(const Job& job, const FrameRequest& request, const FrameResult& result,
                           const std::optional<DisplayTransform>& display) {
    EncodedPictures pictures;
    const EncodeOptions options{request.products, request.format, shownOn(result.tone, display), result.background};
    for (const ViewResult& view : result.views) {
        stopIfCancelled(job);
        appendPicture(view.image, options, pictures);
    }
    if (request.format.hash) hashPayload(pictures);
    return pictures;
}

EncodedPictures picturesOf(const Job& job, const Composite& request, const CompositeResult& result,
                           const std::optional<DisplayTransform>& display) {
    stopIfCancelled(job);
    EncodedPictures pictures;
    appendPicture(result.image, {{Product::color}, request.format, shownOn(result.tone, display)}, pictures);
    if (request.format.hash) hashPayload(pictures);
    return pictures;
}

Message messageOf(const Job& job, const FrameRequest& request, const FrameResult& result, EncodedPictures pictures,
                  const FrameTimes& times) {
    return frameReply({job.id, job.stream, job.number}, request, result, std::move(pictures), times);
}

Message messageOf(const Job& job, const Composite& request, const CompositeResult& result, EncodedPictures pictures,
                  const FrameTimes& times) {
    return compositeReply(job.id, request, result, std::move(pictures), times);
}

/// Encodes a picture, and tells in `report` what that took.
template <class Asked, class Result>
Message encoded(const Job& job, const Result& result, const std::optional<DisplayTransform>& display,
                EncodingReport& report) {
    const Asked& request = std::get<Asked>(*job.work);
    const auto start = Clock::now();
    EncodedPictures pictures = picturesOf(job, request, result, display);
    report = {millisecondsSince(start), millisecondsSince(job.arrived), pictures.pixels};
    return messageOf(job, request, result, std::move(pictures), {report.milliseconds, report.totalMilliseconds});
}

}  // namespace

std::optional<RenderRequest> renderRequest(Request request) {
    return std::visit(
        [](auto&& one) -> std::optional<RenderRequest> {
            using One = std::decay_t<decltype(one)>;
            if constexpr (std::is_constructible_v<RenderRequest, One>)
                return RenderRequest(std::forward<decltype(one)>(one));
            else
                return std::nullopt;
        },
        std::move(request));
}

RenderBridge::RenderBridge(const RenderConfig& config, Instruments& instruments, Send send,
                           std::function<void(std::exception_ptr)> begun)
    : memory_(instruments.memory),
      paths_(config),
      send_(std::move(send)),
      display_(DisplayTransform::ofEnvironment()),
      encoders_(encoderThreads()),
      service_(config, instruments, outlets(std::move(begun))) {}

RenderBridge::~RenderBridge() {
    encoders_.stop();  // they call the service, which ends after this
}

RenderService::Outlets RenderBridge::outlets(std::function<void(std::exception_ptr)> begun) {
    RenderService::Outlets outlets;
    outlets.reply = [this](ClientId client, std::uint64_t id, Reply reply) {
        paths_.hide(reply);
        send_(client, {encodeReply(id, reply), false, {}});
    };
    outlets.begun = std::move(begun);
    outlets.encode = [this](FrameTask task) {
        const ClientId client = task.job.client;
        constexpr std::uint64_t nanosecondsPerByte = 20;  // of what pictures hold: about, for the order alone
        const std::chrono::nanoseconds length(nanosecondsPerByte * task.memory.bytes());
        // std::function wants what can be copied
        encoders_.submit(client, length,
                         [this, shared = std::make_shared<const FrameTask>(std::move(task))] { encode(*shared); });
    };
    outlets.mostEncoding = std::size_t{2} * encoderThreads();
    return outlets;
}

void RenderBridge::dispose(std::shared_ptr<void> gone) {
    constexpr ClientId nobody = 0;
    encoders_.submit(nobody, [gone = std::move(gone)]() mutable { gone.reset(); });
}

void RenderBridge::encode(const FrameTask& task) {
    const Job& job = task.job;
    try {
        EncodingReport report;
        const auto* const frame = std::get_if<FrameResult>(&task.result);
        Message message = frame != nullptr
                              ? encoded<FrameRequest>(job, *frame, display_, report)
                              : encoded<Composite>(job, std::get<CompositeResult>(task.result), display_, report);
        MemoryBudget::Share memory = memory_.hold(MemoryBudget::frames, message.json.size() + message.payload.size());
        service_.finish(task, report, [&] { send_(job.client, {std::move(message), true, std::move(memory)}); });
    } catch (const Cancelled&) {
        service_.failEncoding(task, {"cancelled", "cancelled on request", {}});
    } catch (const std::exception& e) {
        service_.failEncoding(task, {"internal", e.what(), {}});
    }
}

}  // namespace lumulus::service
