#include "service/client/connection.h"

#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>

#include "service/client/lumulus_client.h"

namespace lumulus {
namespace {

constexpr std::string_view unixPrefix = "unix:";
constexpr std::size_t bufferBytes = 256UL << 10U;
/// The server's replies are trusted to be no larger than it can make them.
constexpr service::MessageLimits replyLimits{1U << 26U, std::uint64_t{1} << 34U};

[[noreturn]] void failConnection(const std::string& what, int error) {
    throw ClientError("connection", what + ": " + std::generic_category().message(error));
}

int connectUnix(const std::string& path) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    if (path.size() >= sizeof(name.sun_path)) throw ClientError("connection", path + ": too long for a socket");
    std::memcpy(name.sun_path, path.c_str(), path.size());
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (socket >= 0 && ::connect(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0) return socket;
    const int error = errno;
    if (socket >= 0) ::close(socket);
    failConnection(path, error);
}

int connectTcp(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos) throw ClientError("connection", address + ": give HOST:PORT or unix:PATH");
    std::string host = address.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int error = ::getaddrinfo(host.c_str(), address.substr(colon + 1).c_str(), &hints, &found); error != 0)
        throw ClientError("connection", address + ": " + ::gai_strerror(error));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, ::freeaddrinfo);
    int error = ECONNREFUSED;
    for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
        const int socket = ::socket(one->ai_family, one->ai_socktype | SOCK_CLOEXEC, one->ai_protocol);
        if (socket >= 0 && ::connect(socket, one->ai_addr, one->ai_addrlen) == 0) {
            const int on = 1;
            ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
            return socket;
        }
        error = errno;
        if (socket >= 0) ::close(socket);
    }
    failConnection(address, error);
}

}  // namespace

ClientConnection::ClientConnection(const std::string& address, double timeout)
    : socket_(address.starts_with(unixPrefix) ? connectUnix(address.substr(unixPrefix.size())) : connectTcp(address)),
      timeout_(timeout),
      reader_(replyLimits),
      buffer_(bufferBytes) {}

ClientConnection::~ClientConnection() {
    ::close(socket_);
}

void ClientConnection::wait(short events, std::chrono::steady_clock::time_point until) const {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    pollfd waiting{socket_, events, 0};
    const int ready = left.count() <= 0 ? 0 : ::poll(&waiting, 1, static_cast<int>(left.count()));
    if (ready == 0) throw ClientError("connection", "the server does not answer in time");
    if (ready < 0 && errno != EINTR) failConnection("the connection broke", errno);
}

void ClientConnection::sendAll(std::span<const std::byte> bytes) {
    const auto until =
        std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(timeout_);
    while (!bytes.empty()) {
        wait(POLLOUT, until);
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent >= 0)
            bytes = bytes.subspan(static_cast<std::size_t>(sent));
        else if (errno != EINTR && errno != EAGAIN)
            failConnection("the connection broke", errno);
    }
}

void ClientConnection::send(const service::Message& message) {
    sendAll(service::encodeHead(message));
    sendAll(message.payload);
}

service::Message ClientConnection::receive() {
    const auto until =
        std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(timeout_);
    try {
        while (true) {
            if (auto message = reader_.read(unread_)) return std::move(*message);
            wait(POLLIN, until);
            const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
            if (count == 0) throw ClientError("connection", "the server closed the connection");
            if (count < 0 && errno != EINTR) failConnection("the connection broke", errno);
            unread_ = std::span(buffer_).first(static_cast<std::size_t>(std::max<ssize_t>(0, count)));
        }
    } catch (const service::FramingError& e) {
        throw ClientError("connection", std::string("this is no frame service: ") + e.what());
    }
}

}  // namespace lumulus
