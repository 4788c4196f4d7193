#include "service/net/server.h"

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/net/asio.h"
#include "service/net/frame_server.h"
#include "service/net/http_server.h"
#include "service/net/hub.h"
#include "service/telemetry/event_log.h"

namespace lumulus::service {

namespace {

constexpr auto watchPeriod = std::chrono::milliseconds(250);
/// For replies to leave after the work is done.
constexpr auto farewell = std::chrono::seconds(2);

/// Keeps SIGINT and SIGTERM with the handler of asio until the process is gone: without a set that wants them, asio
/// gives them back to the system, and another one while the server ends would make a failure of it.
void holdSignals() {
    static asio::io_context* const never = new asio::io_context(1);
    static asio::signal_set* const held = new asio::signal_set(*never, SIGINT, SIGTERM);
    (void)held;
}

class Server {
  public:
    explicit Server(const Config& config)
        : hub_(config, [this](std::function<void()> call) { asio::post(io_, std::move(call)); }),
          frames_(io_, hub_),
          pages_(io_, hub_),
          signals_(io_, SIGINT, SIGTERM),
          watch_(io_) {
        holdSignals();
        if (!config.tcp.empty()) frames_.listenTcp(config.tcp);
        if (!config.unixSocket.empty()) frames_.listenUnix(config.unixSocket, config.unixMode);
        if (!config.http.empty()) pages_.listen(config.http);
        logEvent("info", "listening", {{"frames", frames_.addresses()}, {"http", pages_.address()}});
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() {
        if (finishing_.joinable()) finishing_.join();
    }

    void run() {
        asio::co_spawn(io_, watch(), asio::detached);
        if (interrupted()) shutDown();  // while the default scene was loaded
        signals_.async_wait([this](const error_code& error, int) {
            if (!error && !finishing_.joinable()) shutDown();
        });
        io_.run();
        logEvent("info", "stopped", nullptr);
    }

  private:
    asio::awaitable<void> watch() {
        error_code error;
        while (!error) {
            watch_.expires_after(watchPeriod);
            co_await watch_.async_wait(intoError(error));
            hub_.watch(Clock::now());
        }
    }

    void shutDown() {
        logEvent("info", "shutting_down", nullptr);
        hub_.refuseNew();
        frames_.close();
        pages_.close();
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
        const auto latest = Clock::now() + farewell;
        asio::steady_timer timer(io_);
        error_code ignored;
        while (hub_.connections() > 0 && Clock::now() < latest) {
            timer.expires_after(std::chrono::milliseconds(10));
            co_await timer.async_wait(intoError(ignored));
        }
        io_.stop();
    }

    asio::io_context io_{1};
    Hub hub_;
    FrameServer frames_;
    HttpServer pages_;
    asio::signal_set signals_;
    asio::steady_timer watch_;
    std::thread finishing_;
};

}  // namespace

void serve(const Config& config) {
    try {
        Server(config).run();
    } catch (const Error&) {
        if (!interrupted()) throw;
        logEvent("info", "stopped", nullptr);  // before it listened
    }
}

}  // namespace lumulus::service
