#include "service/frame_server.h"

#include <sys/stat.h>

#include <array>

#include "base/error.h"

namespace lumulus::service {

namespace {

using Stream = asio::generic::stream_protocol::socket;
using Local = asio::local::stream_protocol;

constexpr std::size_t readBytes = 64UL << 10U;
/// After a failure to accept, as for want of descriptors.
constexpr auto acceptPause = std::chrono::milliseconds(100);

/// One socket of the protocol: a coroutine that reads and one that writes, which end together.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(Stream socket, Hub& hub) : socket_(std::move(socket)), hub_(hub), wake_(socket_.get_executor()) {
        wake_.expires_at(asio::steady_timer::time_point::max());
    }

    void run(const std::string& from) {
        const std::weak_ptr<Connection> weak = weak_from_this();
        peer_ = hub_.open(from, [weak] {
            if (const auto self = weak.lock()) self->notify();
        });
        if (!peer_) return;
        asio::co_spawn(
            socket_.get_executor(), [self = shared_from_this()] { return self->write(); }, asio::detached);
        asio::co_spawn(
            socket_.get_executor(), [self = shared_from_this()] { return self->read(); }, asio::detached);
    }

  private:
    /// Whoever waits looks again: the writer for something to write, the reader for room.
    void notify() {
        if (peer_ && peer_->finished()) {
            error_code ignored;
            socket_.shutdown(Stream::shutdown_both, ignored);
            socket_.close(ignored);
        }
        wake_.cancel();
    }

    asio::awaitable<void> sleep() {
        error_code woken;
        co_await wake_.async_wait(intoError(woken));
    }

    asio::awaitable<void> read() {
        std::vector<std::byte> buffer(readBytes);
        asio::steady_timer pause(socket_.get_executor());
        error_code error;
        while (!peer_->closing()) {
            const std::size_t count = co_await socket_.async_read_some(asio::buffer(buffer), intoError(error));
            if (error) break;
            hub_.received(*peer_, std::span(buffer).first(count));
            while (peer_->overfull() && !peer_->closing()) co_await sleep();
            if (const auto wait = peer_->pause(Clock::now()); wait > Clock::duration::zero()) {
                pause.expires_after(wait);
                co_await pause.async_wait(intoError(error));
            }
        }
        // what a client is told last, it should be able to read
        while (!error && !peer_->finished()) co_await sleep();
        hub_.close(peer_, error ? error.message() : "closed");
    }

    asio::awaitable<void> write() {
        error_code error;
        while (!error && !peer_->finished()) {
            const Outgoing* out = peer_->next();
            if (out == nullptr) {
                co_await sleep();
                continue;
            }
            const std::size_t total = out->head.size() + out->payload.size();
            for (std::size_t done = 0; done < total && !error;) {
                const std::size_t inHead = std::min(done, out->head.size());
                const std::array<asio::const_buffer, 2> buffers{asio::buffer(out->head) + inHead,
                                                                asio::buffer(out->payload) + (done - inHead)};
                const std::size_t count = co_await socket_.async_write_some(buffers, intoError(error));
                done += count;
                if (!error) hub_.sent(*peer_, count, done == total);
            }
            wake_.cancel();  // the reader may wait for room
        }
        peer_->closeNow();
        notify();
    }

    Stream socket_;
    Hub& hub_;
    asio::steady_timer wake_;
    std::shared_ptr<Peer> peer_;
};

void start(Stream socket, Hub& hub, const std::string& from) {
    std::make_shared<Connection>(std::move(socket), hub)->run(from);
}

asio::awaitable<void> rest() {
    asio::steady_timer timer(co_await asio::this_coro::executor, acceptPause);
    error_code ignored;
    co_await timer.async_wait(intoError(ignored));
}

bool answers(asio::io_context& io, const std::filesystem::path& path) {
    Local::socket probe(io);
    error_code error;
    probe.connect(Local::endpoint(path.string()), error);
    return !error;
}

}  // namespace

Tcp::acceptor makeAcceptor(asio::io_context& io, const TcpAddress& address) {
    const std::string text = address.host + ":" + std::to_string(address.port);
    try {
        return {io, Tcp::endpoint(asio::ip::make_address(address.host), address.port)};
    } catch (const boost::system::system_error& e) {
        throw InputError("cannot listen: " + e.code().message(), text,
                         "choose another address, or end who listens there");
    }
}

std::string addressText(const Tcp::endpoint& endpoint) {
    const std::string host = endpoint.address().to_string();
    const std::string port = std::to_string(endpoint.port());
    return endpoint.address().is_v6() ? "[" + host + "]:" + port : host + ":" + port;
}

FrameServer::FrameServer(asio::io_context& io, Hub& hub) : io_(io), hub_(hub) {}

void FrameServer::listenTcp(const TcpAddress& address) {
    auto acceptor = std::make_shared<Tcp::acceptor>(makeAcceptor(io_, address));
    addresses_.push_back(addressText(acceptor->local_endpoint()));
    tcp_.push_back(acceptor);
    asio::co_spawn(io_, accept(acceptor), asio::detached);
}

void FrameServer::listenUnix(const std::filesystem::path& path, unsigned mode) {
    if (path.string().size() > 100) throw InputError("the path is too long for a socket", path.string(), "shorten it");
    std::error_code ec;
    if (std::filesystem::is_socket(path, ec)) {
        if (answers(io_, path))
            throw InputError("a server listens there", path.string(), "end it, or change listen.unix");
        std::filesystem::remove(path, ec);
    }
    // the socket must never have more permissions than asked for, not even for a moment
    const ::mode_t before = ::umask(static_cast<::mode_t>(~mode & 0777U));
    try {
        auto acceptor = std::make_shared<Local::acceptor>(io_, Local::endpoint(path.string()));
        ::umask(before);
        local_.push_back(acceptor);
        asio::co_spawn(io_, accept(acceptor), asio::detached);
    } catch (const boost::system::system_error& e) {
        ::umask(before);
        throw InputError("cannot listen: " + e.code().message(), path.string(), "change listen.unix");
    }
    addresses_.push_back("unix:" + path.string());
    socketPath_ = path;
}

asio::awaitable<void> FrameServer::accept(std::shared_ptr<Tcp::acceptor> acceptor) {
    while (acceptor->is_open()) {
        error_code error;
        Tcp::socket socket = co_await acceptor->async_accept(intoError(error));
        if (error == asio::error::operation_aborted) co_return;
        if (error) {
            co_await rest();
            continue;
        }
        const Tcp::endpoint from = socket.remote_endpoint(error);
        error_code ignored;
        socket.set_option(Tcp::no_delay(true), ignored);
        socket.set_option(asio::socket_base::keep_alive(true), ignored);
        if (!error) start(Stream(std::move(socket)), hub_, addressText(from));
    }
}

asio::awaitable<void> FrameServer::accept(std::shared_ptr<Local::acceptor> acceptor) {
    while (acceptor->is_open()) {
        error_code error;
        Local::socket socket = co_await acceptor->async_accept(intoError(error));
        if (error == asio::error::operation_aborted) co_return;
        if (error)
            co_await rest();
        else
            start(Stream(std::move(socket)), hub_, "unix");
    }
}

void FrameServer::close() {
    error_code ignored;
    for (const auto& acceptor : tcp_) acceptor->close(ignored);
    for (const auto& acceptor : local_) acceptor->close(ignored);
    std::error_code ec;
    if (!socketPath_.empty()) std::filesystem::remove(socketPath_, ec);
}

}  // namespace lumulus::service
