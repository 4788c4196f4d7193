// The one file that knows Beast: a WebSocket takes the compiler most of a minute.
#include "service/net/http_server.h"

#include <sstream>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "service/net/frame_server.h"
#include "service/net/http_replies.h"
#include "service/net/link.h"
#include "service/net/refusal.h"

namespace lumulus::service {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

namespace {

using Socket = websocket::stream<beast::tcp_stream>;
using HttpRequest = http::request<http::empty_body>;

constexpr std::string_view plainText = "text/plain; charset=utf-8";
constexpr std::uint32_t mostHeaderBytes = 8192;
constexpr auto headerTime = std::chrono::seconds(10);  // for a request to come, or for its reply to go
constexpr std::size_t fragmentBytes = std::size_t{1} << 16U;
constexpr std::size_t readBytes = std::size_t{1} << 16U, strangerReadBytes = std::size_t{1} << 12U;
constexpr std::size_t messageOverhead = std::size_t{1} << 16U, strangerMessageBytes = std::size_t{1} << 16U;
constexpr std::size_t refusalsAtOnce = 32;

HttpQuestion questionOf(const HttpRequest& request) {
    const auto field = [&](http::field name) {
        const auto value = request[name];
        return std::string_view(value.data(), value.size());
    };
    return {{request.target().data(), request.target().size()},
            static_cast<std::size_t>(std::distance(request.equal_range(http::field::host).first,
                                                   request.equal_range(http::field::host).second)),
            request.version() < 11,
            field(http::field::host),
            field(http::field::origin),
            field(http::field::authorization)};
}

/// Bytes over a WebSocket. A message of the protocol goes as one binary message, which comes in fragments, so that a
/// slow reader is seen to read. What comes may be cut into messages anywhere, and is handed on as it comes, so that a
/// message of a WebSocket is never held as a whole.
class WebSocketCarrier {
  public:
    /// `mostBytes` of a message after hello.
    WebSocketCarrier(Socket socket, std::size_t mostBytes)
        : socket_(std::move(socket)), mostBytes_(mostBytes), buffer_(strangerReadBytes) {
        socket_.read_message_max(strangerMessageBytes);
    }

    auto executor() { return socket_.get_executor(); }

    asio::awaitable<std::span<const std::byte>> read(error_code& error) {
        const std::size_t count = co_await socket_.async_read_some(asio::buffer(buffer_), intoError(error));
        co_return std::span(buffer_).first(count);
    }

    void trust() {
        if (buffer_.size() == readBytes) return;
        buffer_.resize(readBytes);
        socket_.read_message_max(mostBytes_);
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
    std::size_t mostBytes_;
    std::vector<std::byte> buffer_;
};

/// Answers the request for a WebSocket, and serves it.
asio::awaitable<void> serveWebSocket(Socket socket, Hub& hub, HttpRequest request, std::string from,
                                     std::shared_ptr<void> seat) {
    beast::get_lowest_layer(socket).expires_never();
    socket.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    const MessageLimits& limits = hub.config().limits.messages;
    const std::size_t mostBytes = limits.jsonBytes + limits.payloadBytes + messageOverhead;
    socket.binary(true);
    socket.auto_fragment(false);  // the carrier does
    error_code error;
    co_await socket.async_accept(request, intoError(error));
    if (error) co_return;
    auto link = std::make_shared<Link<WebSocketCarrier>>(WebSocketCarrier(std::move(socket), mostBytes), hub);
    co_await link->run(from + " websocket", std::move(seat));
}

using HttpResponse = http::response<http::string_body>;

HttpResponse responseOf(HttpReply reply, unsigned version, bool keepAlive, bool withBody) {
    HttpResponse response(static_cast<http::status>(reply.status), version);
    response.set(http::field::server, "lumulus");
    response.set(http::field::content_type, beast::string_view(reply.type.data(), reply.type.size()));
    response.set(http::field::cache_control, "no-cache");
    response.set(http::field::x_frame_options, "DENY");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Content-Security-Policy", "default-src 'self'; img-src 'self' blob:; connect-src 'self' ws: wss:");
    response.keep_alive(keepAlive);
    const std::size_t length = reply.body.size();
    if (withBody) response.body() = std::move(reply.body);
    response.content_length(length);
    return response;
}

std::vector<std::byte> fullText() {
    std::ostringstream text;
    text << responseOf({503, plainText, "too many connections are open: try again later\n"}, 11, false, true);
    const std::string bytes = text.str();
    return {reinterpret_cast<const std::byte*>(bytes.data()),
            reinterpret_cast<const std::byte*>(bytes.data()) + bytes.size()};
}

/// What is said to bytes that are no request; none to a connection that has ended or was silent.
std::optional<HttpReply> complaintAbout(const error_code& error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
        return HttpReply{431, plainText, "the header is too long\n"};
    if (error == http::error::body_limit || error == http::error::unexpected_body)
        return HttpReply{413, plainText, "requests have no body here\n"};
    const bool malformed = error.category() == make_error_code(http::error::bad_version).category() &&
                           error != http::error::end_of_stream && error != http::error::partial_message;
    if (malformed) return HttpReply{400, plainText, "this is no HTTP request\n"};
    return std::nullopt;
}

/// One connection that speaks HTTP.
class HttpSession {
  public:
    HttpSession(beast::tcp_stream& stream, Hub& hub, const std::string& from)
        : stream_(stream), hub_(hub), from_(from), buffer_(mostHeaderBytes * 2) {}

    /// Answers requests one by one. Returns one for a WebSocket, or none where the connection ends.
    asio::awaitable<std::optional<HttpRequest>> serve() {
        error_code error;
        while (true) {
            stream_.expires_after(headerTime);
            http::request_parser<http::empty_body> parser;
            parser.header_limit(mostHeaderBytes);
            parser.body_limit(0);
            co_await http::async_read(stream_, buffer_, parser, intoError(error));
            if (error) {
                if (auto complaint = complaintAbout(error)) {
                    co_await write(responseOf(std::move(*complaint), 11, false, true), error);
                    co_await drain();
                }
                co_return std::nullopt;
            }
            HttpRequest request = parser.release();
            const HttpQuestion question = questionOf(request);
            if (isWebSocket(request, question)) co_return request;
            const bool get = request.method() == http::verb::get, head = request.method() == http::verb::head;
            HttpReply reply{405, plainText, "only GET and HEAD are known here\n"};
            if (auto bad = malformed(question))
                reply = std::move(*bad);
            else if (!hostAllowed(question, hub_.config()))
                reply = {403, plainText, "this host name is not known here: see listen.host_names\n"};
            else if (get || head)
                reply = co_await answer(question);
            const bool keep = request.keep_alive() && reply.status < 500;
            co_await write(responseOf(std::move(reply), request.version(), keep, !head), error);
            if (error || !keep) co_return std::nullopt;
        }
    }

  private:
    bool isWebSocket(const HttpRequest& request, const HttpQuestion& question) const {
        return websocket::is_upgrade(request) && question.target == "/frames" && !malformed(question) &&
               hostAllowed(question, hub_.config());
    }

    asio::awaitable<HttpReply> answer(const HttpQuestion& question) {
        if (pathOf(question) == "/metrics" && !hub_.config().token.empty()) {
            asio::steady_timer timer(stream_.get_executor());
            const auto latest = Clock::now() + headerTime;
            error_code ignored;
            for (auto wait = hub_.mayGuess(from_); wait != Clock::duration::zero(); wait = hub_.mayGuess(from_)) {
                if (Clock::now() + wait > latest)
                    co_return HttpReply{429, plainText, "too many wrong tokens came from this address\n"};
                timer.expires_after(wait);
                co_await timer.async_wait(intoError(ignored));
            }
            const bool right = tokenGiven(question, hub_.config());
            hub_.guessed(from_, right);
            if (!right) co_return tokenWanted();
        }
        co_return httpReply(question, hub_.service().notReady(), hub_.metrics());
    }

    asio::awaitable<void> write(HttpResponse response, error_code& error) {
        http::response_serializer<http::string_body> serializer(response);
        co_await http::async_write(stream_, serializer, intoError(error));
    }

    /// Reads what comes still, for a second at most: closed with bytes unread, a socket takes back what it was sent.
    asio::awaitable<void> drain() {
        error_code error;
        stream_.expires_after(std::chrono::seconds(1));
        stream_.socket().shutdown(Tcp::socket::shutdown_send, error);
        std::array<std::byte, 4096> rest;
        while (!error) co_await stream_.async_read_some(asio::buffer(rest), intoError(error));
    }

    beast::tcp_stream& stream_;
    Hub& hub_;
    const std::string& from_;
    beast::flat_buffer buffer_;
};

asio::awaitable<void> session(Tcp::socket socket, Hub& hub, std::string from, std::shared_ptr<void> seat) {
    beast::tcp_stream stream(std::move(socket));
    std::optional<HttpRequest> upgrade;
    {
        HttpSession http(stream, hub, from);
        upgrade = co_await http.serve();
    }
    if (upgrade) {
        co_await serveWebSocket(Socket(std::move(stream)), hub, std::move(*upgrade), from, std::move(seat));
    } else {
        error_code ignored;
        stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    }
}

}  // namespace

HttpServer::HttpServer(asio::io_context& io, Hub& hub)
    : io_(io), hub_(hub), seats_(hub.config().limits.httpConnections), refusals_(refusalsAtOnce) {}

void HttpServer::listen(const TcpAddress& address) {
    acceptor_ = std::make_shared<Tcp::acceptor>(makeAcceptor(io_, address));
    address_ = addressText(acceptor_->local_endpoint());
    const auto take = [this](Tcp::socket socket) {
        error_code error;
        const Tcp::endpoint from = socket.remote_endpoint(error);
        if (error) return;
        if (auto seat = seats_.take()) {
            asio::co_spawn(io_, session(std::move(socket), hub_, addressText(from), std::move(seat)), asio::detached);
            return;
        }
        hub_.metrics().add(Metrics::connectionsRefused);
        asio::co_spawn(io_, refuse(std::move(socket), fullText(), refusals_.take()), asio::detached);
    };
    asio::co_spawn(io_, acceptAll(acceptor_, take), asio::detached);
}

void HttpServer::close() {
    error_code ignored;
    if (acceptor_) acceptor_->close(ignored);
}

}  // namespace lumulus::service
