#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "service/net/asio.h"
#include "service/net/seats.h"

namespace lumulus::service {

/// Tells a connection that is not served why, and ends it. Reads on until the other side ends too, for a second at
/// most: closed with bytes unread, a socket takes back what it was sent. `seat` is taken meanwhile; without one the
/// socket is closed at once.
template <class Socket>
asio::awaitable<void> refuse(Socket connection, std::vector<std::byte> answer, std::shared_ptr<void> seat) {
    if (!seat) co_return;
    const auto socket = std::make_shared<Socket>(std::move(connection));
    asio::steady_timer limit(socket->get_executor(), std::chrono::seconds(1));
    limit.async_wait([socket](const error_code& stopped) {
        error_code ignored;
        if (!stopped) socket->close(ignored);
    });
    error_code error, ignored;
    co_await asio::async_write(*socket, asio::buffer(answer), intoError(error));
    socket->shutdown(Socket::shutdown_send, ignored);
    std::array<std::byte, 4096> rest;
    while (!error) co_await socket->async_read_some(asio::buffer(rest), intoError(error));
}

}  // namespace lumulus::service
