#include "service/net/frame_server.h"

#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>

#include "base/error.h"
#include "service/net/link.h"
#include "service/net/refusal.h"
#include "service/protocol/error_reply.h"

namespace lumulus::service {

namespace {

using Stream = asio::generic::stream_protocol::socket;
using Local = asio::local::stream_protocol;

constexpr std::size_t readBytes = 64UL << 10U, strangerBytes = 4UL << 10U;
/// A reader that takes what the kernel copies would keep the thread copying: milliseconds for a large picture.
constexpr std::size_t writtenBytes = 256UL << 10U;
constexpr std::size_t refusalsAtOnce = 32;

/// Bytes over a stream socket.
class StreamCarrier {
  public:
    explicit StreamCarrier(Stream socket) : socket_(std::move(socket)), buffer_(strangerBytes) {}

    auto executor() { return socket_.get_executor(); }

    asio::awaitable<std::span<const std::byte>> read(error_code& error) {
        const std::size_t count = co_await socket_.async_read_some(asio::buffer(buffer_), intoError(error));
        co_return std::span(buffer_).first(count);
    }

    asio::awaitable<std::size_t> write(const std::vector<std::byte>& head, const std::vector<std::byte>& payload,
                                       std::size_t done, error_code& error) {
        const std::size_t inHead = std::min(done, head.size());
        const std::array<asio::const_buffer, 2> buffers{
            asio::buffer(head) + inHead,
            asio::buffer(payload.data() + (done - inHead), std::min(payload.size() - (done - inHead), writtenBytes))};
        co_return co_await socket_.async_write_some(buffers, intoError(error));
    }

    void trust() { buffer_.resize(readBytes); }

    void close() {
        error_code ignored;
        socket_.shutdown(Stream::shutdown_both, ignored);
        socket_.close(ignored);
    }

  private:
    Stream socket_;
    std::vector<std::byte> buffer_;
};

/// Of the user at the other end of a Unix socket.
std::string userText(Local::socket& socket) {
    ::ucred user{};
    ::socklen_t size = sizeof(user);
    const bool known = ::getsockopt(socket.native_handle(), SOL_SOCKET, SO_PEERCRED, &user, &size) == 0;
    return known ? "unix uid " + std::to_string(user.uid) : "unix";
}

std::vector<std::byte> fullText() {
    return encodeHead(errorReply(0, "busy", "too many connections are open: try again later"));
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

FrameServer::FrameServer(asio::io_context& io, Hub& hub)
    : io_(io), hub_(hub), seats_(hub.config().limits.connections), refusals_(refusalsAtOnce) {}

void FrameServer::take(Stream socket, const std::string& from) {
    auto seat = seats_.take();
    if (!seat) {
        hub_.metrics().add(Metrics::connectionsRefused);
        asio::co_spawn(io_, refuse(std::move(socket), fullText(), refusals_.take()), asio::detached);
        return;
    }
    auto link = std::make_shared<Link<StreamCarrier>>(StreamCarrier(std::move(socket)), hub_);
    asio::co_spawn(
        io_, [link, from, seat = std::move(seat)] { return link->run(from, seat); }, asio::detached);
}

void FrameServer::listenTcp(const TcpAddress& address) {
    auto acceptor = std::make_shared<Tcp::acceptor>(makeAcceptor(io_, address));
    addresses_.push_back(addressText(acceptor->local_endpoint()));
    tcp_.push_back(acceptor);
    const auto accepted = [this](Tcp::socket socket) {
        error_code error, ignored;
        const Tcp::endpoint from = socket.remote_endpoint(error);
        socket.set_option(Tcp::no_delay(true), ignored);
        socket.set_option(asio::socket_base::keep_alive(true), ignored);
        if (!error) take(Stream(std::move(socket)), addressText(from));
    };
    asio::co_spawn(io_, acceptAll(acceptor, accepted), asio::detached);
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
        const auto accepted = [this](Local::socket socket) {
            const std::string from = userText(socket);
            take(Stream(std::move(socket)), from);
        };
        asio::co_spawn(io_, acceptAll(acceptor, accepted), asio::detached);
    } catch (const boost::system::system_error& e) {
        ::umask(before);
        throw InputError("cannot listen: " + e.code().message(), path.string(), "change listen.unix");
    }
    addresses_.push_back("unix:" + path.string());
    socketPath_ = path;
}

void FrameServer::close() {
    error_code ignored;
    for (const auto& acceptor : tcp_) acceptor->close(ignored);
    for (const auto& acceptor : local_) acceptor->close(ignored);
    std::error_code ec;
    if (!socketPath_.empty()) std::filesystem::remove(socketPath_, ec);
}

}  // namespace lumulus::service
