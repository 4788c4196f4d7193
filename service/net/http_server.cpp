// The one file that knows Beast: a WebSocket takes the compiler most of a minute.
#include "service/net/http_server.h"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "service/net/frame_server.h"
#include "service/net/http_replies.h"
#include "service/net/link.h"

namespace lumulus::service {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

namespace {

using Socket = websocket::stream<beast::tcp_stream>;
using HttpRequest = http::request<http::empty_body>;

constexpr std::uint32_t mostHeaderBytes = 8192;
constexpr auto headerTime = std::chrono::seconds(10);  // for a request to come, or for its reply to go
constexpr std::size_t fragmentBytes = std::size_t{1} << 18U;
constexpr std::size_t messageOverhead = std::size_t{1} << 16U;

HttpQuestion questionOf(const HttpRequest& request) {
    const auto field = [&](http::field name) {
        const auto value = request[name];
        return std::string_view(value.data(), value.size());
    };
    return {{request.target().data(), request.target().size()},
            field(http::field::host),
            field(http::field::origin),
            field(http::field::authorization)};
}

/// Bytes over a WebSocket. A message of the protocol goes as one binary message, which comes in fragments, so that a
/// slow reader is seen to read; what comes may be cut into messages anywhere.
class WebSocketCarrier {
  public:
    explicit WebSocketCarrier(Socket socket) : socket_(std::move(socket)) {}

    auto executor() { return socket_.get_executor(); }

    asio::awaitable<std::span<const std::byte>> read(error_code& error) {
        buffer_.clear();
        co_await socket_.async_read(buffer_, intoError(error));
        co_return std::span(static_cast<const std::byte*>(buffer_.cdata().data()), buffer_.size());
    }

    asio::awaitable<std::size_t> write(const std::vector<std::byte>& head, const std::vector<std::byte>& payload,
                                       std::size_t done, error_code& error) {
        const std::size_t inHead = std::min(done, head.size());
        const std::size_t fromHead = head.size() - inHead;
        const std::size_t count = std::min(fragmentBytes, fromHead + payload.size() - (done - inHead));
        const std::array<asio::const_buffer, 2> buffers{
            asio::buffer(head.data() + inHead, std::min(fromHead, count)),
            asio::buffer(payload.data() + (done - inHead), count - std::min(fromHead, count))};
        co_await socket_.async_write_some(done + count == head.size() + payload.size(), buffers, intoError(error));
        co_return count;
    }

    void close() { beast::get_lowest_layer(socket_).close(); }

  private:
    Socket socket_;
    beast::flat_buffer buffer_;
};

/// Answers the request for a WebSocket, and serves it.
asio::awaitable<void> serveWebSocket(Socket socket, Hub& hub, HttpRequest request, std::string from) {
    beast::get_lowest_layer(socket).expires_never();
    socket.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    const MessageLimits& limits = hub.config().limits.messages;
    socket.read_message_max(limits.jsonBytes + limits.payloadBytes + messageOverhead);
    socket.binary(true);
    socket.auto_fragment(false);  // the carrier does
    error_code error;
    co_await socket.async_accept(request, intoError(error));
    if (error) co_return;
    auto link = std::make_shared<Link<WebSocketCarrier>>(WebSocketCarrier(std::move(socket)), hub);
    co_await link->run(from + " websocket");
}

http::response<http::string_body> responseTo(const HttpRequest& request, Hub& hub) {
    const HttpQuestion question = questionOf(request);
    HttpReply reply{405, "text/plain", "only GET and HEAD are known here\n"};
    if (!hostAllowed(question, hub.config()))
        reply = {403, "text/plain", "this host name is not known here: see listen.host_names\n"};
    else if (request.method() == http::verb::get || request.method() == http::verb::head)
        reply = httpReply(question, hub.config(), hub.metrics());
    http::response<http::string_body> response(static_cast<http::status>(reply.status), request.version());
    response.set(http::field::server, "lumulus");
    response.set(http::field::content_type, beast::string_view(reply.type.data(), reply.type.size()));
    response.set(http::field::cache_control, "no-cache");
    response.set(http::field::x_frame_options, "DENY");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Content-Security-Policy", "default-src 'self'; img-src 'self' blob:; connect-src 'self' ws: wss:");
    response.keep_alive(request.keep_alive());
    const std::size_t length = reply.body.size();
    if (request.method() != http::verb::head) response.body() = std::move(reply.body);
    response.content_length(length);
    return response;
}

/// Counts among the connections as long as it lives.
class Counted {
  public:
    explicit Counted(Hub& hub) : count_(hub.others()) { ++*count_; }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    ~Counted() { --*count_; }

  private:
    std::shared_ptr<std::size_t> count_;
};

/// Answers requests one by one. Returns one for a WebSocket, or none where the connection ends.
asio::awaitable<std::optional<HttpRequest>> answer(beast::tcp_stream& stream, Hub& hub) {
    const Counted counted(hub);
    beast::flat_buffer buffer(mostHeaderBytes * 2);
    error_code error;
    while (true) {
        stream.expires_after(headerTime);
        http::request_parser<http::empty_body> parser;
        parser.header_limit(mostHeaderBytes);
        parser.body_limit(0);
        co_await http::async_read(stream, buffer, parser, intoError(error));
        if (error) co_return std::nullopt;
        HttpRequest request = parser.release();
        const HttpQuestion question = questionOf(request);
        if (websocket::is_upgrade(request) && question.target == "/frames" && hostAllowed(question, hub.config()))
            co_return request;
        auto response = responseTo(request, hub);
        const bool keep = response.keep_alive();
        http::response_serializer<http::string_body> serializer(response);
        if (request.method() == http::verb::head)
            co_await http::async_write_header(stream, serializer, intoError(error));
        else
            co_await http::async_write(stream, serializer, intoError(error));
        if (error || !keep) co_return std::nullopt;
    }
}

asio::awaitable<void> session(Tcp::socket socket, Hub& hub, std::string from) {
    beast::tcp_stream stream(std::move(socket));
    std::optional<HttpRequest> upgrade = co_await answer(stream, hub);
    if (upgrade) {
        co_await serveWebSocket(Socket(std::move(stream)), hub, std::move(*upgrade), from);
    } else {
        error_code ignored;
        stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    }
}

}  // namespace

HttpServer::HttpServer(asio::io_context& io, Hub& hub) : io_(io), hub_(hub) {}

void HttpServer::listen(const TcpAddress& address) {
    acceptor_ = std::make_shared<Tcp::acceptor>(makeAcceptor(io_, address));
    address_ = addressText(acceptor_->local_endpoint());
    const auto take = [this](Tcp::socket socket) {
        error_code error;
        const Tcp::endpoint from = socket.remote_endpoint(error);
        if (!error && !hub_.full())
            asio::co_spawn(io_, session(std::move(socket), hub_, addressText(from)), asio::detached);
    };
    asio::co_spawn(io_, acceptAll(acceptor_, take), asio::detached);
}

void HttpServer::close() {
    error_code ignored;
    if (acceptor_) acceptor_->close(ignored);
}

}  // namespace lumulus::service
