// The one file that knows Beast: a WebSocket takes the compiler most of a minute.
#include "service/http_server.h"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "service/frame_server.h"
#include "service/http_replies.h"

namespace lumulus::service {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

namespace {

using Socket = websocket::stream<beast::tcp_stream>;
using HttpRequest = http::request<http::empty_body>;

constexpr std::uint32_t mostHeaderBytes = 8192;
constexpr auto headerTime = std::chrono::seconds(10);  // for a request to come, or for its reply to go
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

/// The protocol over a WebSocket: one binary message is any number of bytes of it.
class SocketConnection : public std::enable_shared_from_this<SocketConnection> {
  public:
    SocketConnection(Socket socket, Hub& hub)
        : socket_(std::move(socket)), hub_(hub), wake_(socket_.get_executor()), pause_(socket_.get_executor()) {
        wake_.expires_at(asio::steady_timer::time_point::max());
    }

    asio::awaitable<void> run(HttpRequest request, std::string from) {
        beast::get_lowest_layer(socket_).expires_never();
        socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
        const Config& config = hub_.config();
        socket_.read_message_max(config.limits.messages.jsonBytes + config.limits.messages.payloadBytes +
                                 messageOverhead);
        socket_.binary(true);
        error_code error;
        co_await socket_.async_accept(request, intoError(error));
        if (error) co_return;
        const std::weak_ptr<SocketConnection> weak = weak_from_this();
        peer_ = hub_.open(from + " websocket", [weak] {
            if (const auto self = weak.lock()) self->notify();
        });
        if (!peer_) co_return;
        asio::co_spawn(
            socket_.get_executor(), [self = shared_from_this()] { return self->write(); }, asio::detached);
        co_await read();
    }

  private:
    void notify() {
        if (peer_->finished()) beast::get_lowest_layer(socket_).close();
        wake_.cancel();
    }

    asio::awaitable<void> sleep() {
        error_code woken;
        co_await wake_.async_wait(intoError(woken));
    }

    asio::awaitable<void> read() {
        beast::flat_buffer buffer;
        error_code error;
        while (!peer_->closing()) {
            co_await socket_.async_read(buffer, intoError(error));
            if (error) break;
            const auto* data = static_cast<const std::byte*>(buffer.cdata().data());
            hub_.received(*peer_, std::span(data, buffer.size()));
            buffer.clear();
            while (peer_->overfull() && !peer_->closing()) co_await sleep();
            if (const auto wait = peer_->pause(Clock::now()); wait > Clock::duration::zero()) {
                pause_.expires_after(wait);
                co_await pause_.async_wait(intoError(error));
            }
        }
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
            const std::array<asio::const_buffer, 2> buffers{asio::buffer(out->head), asio::buffer(out->payload)};
            const std::size_t count = co_await socket_.async_write(buffers, intoError(error));
            if (!error) hub_.sent(*peer_, count, true);
            wake_.cancel();  // the reader may wait for room
        }
        peer_->closeNow();
        notify();
    }

    Socket socket_;
    Hub& hub_;
    asio::steady_timer wake_, pause_;
    std::shared_ptr<Peer> peer_;
};

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
        co_await std::make_shared<SocketConnection>(Socket(std::move(stream)), hub)->run(std::move(*upgrade), from);
    } else {
        error_code ignored;
        stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    }
}

}  // namespace

HttpServer::HttpServer(asio::io_context& io, Hub& hub) : io_(io), hub_(hub) {}

void HttpServer::listen(const TcpAddress& address) {
    acceptor_ = std::make_unique<Tcp::acceptor>(makeAcceptor(io_, address));
    address_ = addressText(acceptor_->local_endpoint());
    asio::co_spawn(io_, accept(), asio::detached);
}

asio::awaitable<void> HttpServer::accept() {
    asio::steady_timer pause(io_);
    while (acceptor_->is_open()) {
        error_code error;
        Tcp::socket socket = co_await acceptor_->async_accept(intoError(error));
        if (error == asio::error::operation_aborted) co_return;
        if (error) {
            pause.expires_after(std::chrono::milliseconds(100));
            co_await pause.async_wait(intoError(error));
            continue;
        }
        const Tcp::endpoint from = socket.remote_endpoint(error);
        if (!error && !hub_.full())
            asio::co_spawn(io_, session(std::move(socket), hub_, addressText(from)), asio::detached);
    }
}

void HttpServer::close() {
    error_code ignored;
    if (acceptor_) acceptor_->close(ignored);
}

}  // namespace lumulus::service
