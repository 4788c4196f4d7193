#include "service/net/server.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/net/asio.h"
#include "service/net/frame_server.h"
#include "service/net/handler_times.h"
#include "service/net/http_server.h"
#include "service/net/hub.h"
#include "service/net/supervisor.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

namespace {

constexpr auto watchPeriod = std::chrono::milliseconds(250);
/// Least time for replies to leave after the work is done.
constexpr auto farewell = std::chrono::milliseconds(500);
/// After which a process ends whose threads do not.
constexpr auto lastPatience = std::chrono::seconds(3);

Clock::duration inSeconds(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// Keeps SIGINT and SIGTERM with the handler of asio until the process is gone: without a set that wants them, asio
/// gives them back to the system, and another one while the server ends would make a failure of it.
void holdSignals() {
    static asio::io_context* const never = new asio::io_context(1);
    static asio::signal_set* const held = new asio::signal_set(*never, SIGINT, SIGTERM);
    (void)held;
}

/// Ends a process whose threads do not end in time.
class LastResort {
  public:
    explicit LastResort(EventLog& log) : log_(log) {}
    LastResort(const LastResort&) = delete;
    LastResort& operator=(const LastResort&) = delete;
    ~LastResort() {
        if (!thread_.joinable()) return;
        ended_.set_value();
        thread_.join();
    }

    void begin(Clock::time_point until) {
        thread_ = std::thread([this, until, ended = ended_.get_future()] {
            if (ended.wait_until(until) == std::future_status::ready) return;
            log_.event("warning", "stopped_at_work", nullptr);
            std::_Exit(EXIT_SUCCESS);  // what was promised is answered, and files are whole or not there
        });
    }

  private:
    EventLog& log_;
    std::promise<void> ended_;
    std::thread thread_;
};

class Server {
  public:
    explicit Server(const Config& config)
        : config_(config),
          instruments_(config.render.limits.memoryBytes),
          hub_(
              config, instruments_, [this](std::function<void()> call) { asio::post(io_, std::move(call)); },
              [this](const std::exception_ptr& error) { begun(error); }),
          frames_(io_, hub_),
          pages_(io_, hub_),
          signals_(io_, SIGINT, SIGTERM),
          watch_(io_) {
        holdSignals();
        if (!config.tcp.empty()) frames_.listenTcp(config.tcp);
        if (!config.unixSocket.empty()) frames_.listenUnix(config.unixSocket, config.unixMode);
        if (!config.http.empty()) pages_.listen(config.http);
        instruments_.log.event("info", "listening", {{"frames", frames_.addresses()}, {"http", pages_.address()}});
        supervisor_.ready("listening, and loading the default scene");
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() {
        if (finishing_.joinable()) finishing_.join();
    }

    void run() {
        asio::co_spawn(io_, watch(), asio::detached);
        if (interrupted()) shutDown();  // before there was a handler
        signals_.async_wait([this](const error_code& error, int) {
            if (!error && !finishing_.joinable()) shutDown();
        });
        const HandlerTimes times(instruments_.metrics);
        io_.run();
        instruments_.log.event("info", "stopped", nullptr);
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    asio::awaitable<void> watch() {
        error_code error;
        while (!error) {
            watch_.expires_after(watchPeriod);
            co_await watch_.async_wait(intoError(error));
            hub_.watch(Clock::now());
            if (hub_.service().alive()) supervisor_.alive(Clock::now());
        }
    }

    /// The default scene is there, or cannot be.
    void begun(const std::exception_ptr& error) {
        if (finishing_.joinable()) return;
        if (error) {
            failure_ = error;
            shutDown();
            return;
        }
        instruments_.log.event("info", "ready", nullptr);
        supervisor_.status("serving");
    }

    void shutDown() {
        instruments_.log.event("info", "shutting_down", nullptr);
        supervisor_.stopping();
        latest_ = Clock::now() + inSeconds(config_.render.limits.shutdownSeconds);
        frames_.close();
        pages_.close();
        resort_.begin(latest_ + lastPatience);
        finishing_ = std::thread([this] {
            hub_.finishWork();
            interrupt();  // what the threads of rendering are at still, nobody waits for
            // after the replies, which were posted before
            asio::post(io_, [this] {
                hub_.closeAll();
                asio::co_spawn(io_, leave(), asio::detached);
            });
        });
    }

    asio::awaitable<void> leave() {
        const auto latest = std::max(latest_, Clock::now() + farewell);
        asio::steady_timer timer(io_);
        error_code ignored;
        while (hub_.connections() > 0 && Clock::now() < latest) {
            timer.expires_after(std::chrono::milliseconds(10));
            co_await timer.async_wait(intoError(ignored));
        }
        io_.stop();
    }

    const Config& config_;
    Instruments instruments_;
    LastResort resort_{instruments_.log};  // ends after all other threads
    Supervisor supervisor_;
    asio::io_context io_{1};
    Hub hub_;
    FrameServer frames_;
    HttpServer pages_;
    asio::signal_set signals_;
    asio::steady_timer watch_;
    std::thread finishing_;
    Clock::time_point latest_;  // for replies to leave
    std::exception_ptr failure_;
};

}  // namespace

void serve(const Config& config) {
    Server(config).run();
}

}  // namespace lumulus::service
