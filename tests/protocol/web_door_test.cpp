#include "protocol/stream/web_door.h"

#include <fstream>

#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/handshake_thread.h"
#include "random_message.h"
#include "stream_pair.h"
#include "tls_identity.h"

namespace framelet {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

WebPage small_page() {
    WebPage page;
    page.files = {{"index.html", "<p>a page</p>", "", "\"1\""},
                  {"viewer.wasm", std::string(70000, 'w'), "zip", "\"2\""}};
    return page;
}

WebRequest request(http::verb verb, std::string const& target, std::string const& host = "localhost:7070") {
    WebRequest out{verb, target, 11};
    out.set(http::field::host, host);
    return out;
}

WebRequest upgrade(std::string const& origin, std::string const& host = "localhost:7070") {
    WebRequest out = request(http::verb::get, "/session", host);
    out.set(http::field::upgrade, "websocket");
    out.set(http::field::connection, "upgrade");
    out.set(http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
    out.set(http::field::sec_websocket_version, "13");
    if (!origin.empty()) {
        out.set(http::field::origin, origin);
    }
    return out;
}

/// The status of the answer; 101 where a session is opened.
unsigned status(WebRequest const& asked, WebPage const& page = small_page(), bool on_loopback = true) {
    auto const answer = web_answer(asked, page, on_loopback);
    return answer ? answer->result_int() : 101;
}

TEST(WebDoor, AnswersItsFilesAndNothingElse) {
    WebResponse const index = web_answer(request(http::verb::get, "/"), small_page(), true).value();
    EXPECT_EQ(index.result_int(), 200u);
    EXPECT_EQ(index.body(), "<p>a page</p>");
    EXPECT_EQ(index[http::field::content_type], "text/html; charset=utf-8");
    EXPECT_EQ(index["X-Content-Type-Options"], "nosniff");
    EXPECT_NE(index["Content-Security-Policy"].find("default-src 'none'"), beast::string_view::npos);
    EXPECT_EQ(status(request(http::verb::get, "/index.html?x=1")), 200u);
    EXPECT_EQ(status(request(http::verb::post, "/")), 405u);
    EXPECT_EQ(status(request(http::verb::options, "*")), 405u);
    for (char const* other :
         {"/other", "/../index.html", "//index.html", "/%2e%2e/etc/passwd", "http://x/", "/session"}) {
        EXPECT_EQ(status(request(http::verb::get, other)), 404u) << other;
    }
}

TEST(WebDoor, HeadHasTheLengthAlone) {
    WebResponse const answer = web_answer(request(http::verb::head, "/viewer.wasm"), small_page(), true).value();
    EXPECT_EQ(answer[http::field::content_length], "70000");
    EXPECT_TRUE(answer.body().empty());
}

TEST(WebDoor, CompressedWhereThatIsTaken) {
    WebRequest asked = request(http::verb::get, "/viewer.wasm");
    EXPECT_EQ(web_answer(asked, small_page(), true)->body().size(), 70000u);
    asked.set(http::field::accept_encoding, "br, gzip");
    WebResponse const answer = web_answer(asked, small_page(), true).value();
    EXPECT_EQ(answer.body(), "zip");
    EXPECT_EQ(answer[http::field::content_encoding], "gzip");
    EXPECT_EQ(answer[http::field::content_type], "application/wasm");
}

TEST(WebDoor, WhatTheBrowserHasIsNotSentAgain) {
    WebRequest asked = request(http::verb::get, "/viewer.wasm");
    asked.set(http::field::if_none_match, "\"2\"");
    WebResponse const answer = web_answer(asked, small_page(), true).value();
    EXPECT_EQ(answer.result_int(), 304u);
    EXPECT_TRUE(answer.body().empty());
    asked.set(http::field::if_none_match, "\"1\"");
    EXPECT_EQ(status(asked), 200u);
}

TEST(WebDoor, OnlyPagesOfItsOwnOriginMayConnect) {
    EXPECT_EQ(status(upgrade("http://localhost:7070")), 101u);
    EXPECT_EQ(status(upgrade("https://LOCALHOST:7070")), 101u) << "something before it may do TLS";
    EXPECT_EQ(status(upgrade("")), 101u) << "no browser";
    for (char const* other : {"http://localhost:8080", "http://localhost", "http://evil.example", "null",
                              "http://localhost:7070.evil.example", "ftp://localhost:7070"}) {
        EXPECT_EQ(status(upgrade(other)), 403u) << other;
    }
    WebPage page = small_page();
    page.origin = "https://other.example";
    EXPECT_EQ(status(upgrade("https://other.example"), page), 101u);
    EXPECT_EQ(status(upgrade("http://other.example"), page), 403u);
}

TEST(WebDoor, APageIsToldThatItIsNotLetIn) {
    WebRequest asked = request(http::verb::post, "/session");
    asked.set(http::field::origin, "http://localhost:7070");
    EXPECT_EQ(status(asked), 405u) << "it would be let in";
    asked.set(http::field::origin, "http://127.0.0.1:7070");
    WebResponse const answer = web_answer(asked, small_page(), true).value();
    EXPECT_EQ(answer.result_int(), 403u);
    EXPECT_NE(answer.body().find("--web-origin"), std::string::npos);
}

TEST(WebDoor, OnTheLoopbackOnlyNamesOfThisMachine) {
    for (char const* host :
         {"localhost", "LocalHost:1", "a.localhost:1", "127.0.0.1:7070", "127.9.9.9", "[::1]:7070"}) {
        EXPECT_EQ(status(request(http::verb::get, "/", host)), 200u) << host;
    }
    for (char const* host :
         {"evil.example", "notlocalhost", "localhost.evil.example", "192.0.2.1", "[2001:db8::1]", "", "[", ":7070"}) {
        EXPECT_EQ(status(request(http::verb::get, "/", host)), 403u) << host;
    }
    EXPECT_EQ(status(request(http::verb::get, "/", "render.example"), small_page(), false), 200u);
    EXPECT_EQ(status(upgrade("http://evil.example", "evil.example")), 403u);
    WebPage page = small_page();
    page.origin = "https://render.example";
    EXPECT_EQ(status(request(http::verb::get, "/", "render.example"), page), 200u) << "a proxy of this machine asks";
}

TEST(WebDoor, ReadsTheFilesOfAFolder) {
    std::filesystem::path const folder =
        std::filesystem::temp_directory_path() / ("framelet-web-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    EXPECT_THROW(read_web_page(folder), InputError);
    for (char const* name : {"index.html", "a.js", "a.js.gz", "notes.txt"}) {
        std::ofstream(folder / name) << name;
    }
    WebPage const page = read_web_page(folder);
    std::filesystem::remove_all(folder);
    ASSERT_EQ(page.files.size(), 2u) << "nothing whose type is unknown";
    for (WebFile const& file : page.files) {
        EXPECT_EQ(file.content, file.name);
        EXPECT_EQ(file.compressed, file.name == "a.js" ? "a.js.gz" : "");
    }
    EXPECT_NE(page.files[0].tag, page.files[1].tag);
}

// --- over sockets

class WebStream : public testing::Test {
protected:
    IoThread thread_;
    std::pair<Socket, Socket> sockets_ = thread_.connect();
    Socket& browser_ = sockets_.first;
    End end{plain_stream(std::move(sockets_.second), std::make_shared<WebPage>(small_page()))};

    void write(std::string const& text) { asio::write(browser_, asio::buffer(text)); }
    std::string answer() {
        Bytes const all = read_to_end(browser_);
        return {reinterpret_cast<char const*>(all.data()), all.size()};
    }
};

/// A stream takes what comes through a WebSocket, in pieces of any length, and answers so.
template <typename Browser>
void expect_messages_both_ways(Browser& browser, End& end) {
    std::vector<Message> sent;
    Bytes bytes;
    RandomMessages random(5);
    for (int i = 0; i < 300; ++i) {
        sent.push_back(random.lasting_message());
        Bytes const frame = framed(encode_message(sent.back()));
        bytes.insert(bytes.end(), frame.begin(), frame.end());
    }
    browser.binary(true);
    for (std::size_t at = 0, piece = 0; at < bytes.size(); at += piece) {
        piece = std::min<std::size_t>(random.any64() % 3 == 0 ? random.any64() % 8 : random.any64() % 5000,
                                      bytes.size() - at);
        browser.write(asio::buffer(bytes.data() + at, piece));
    }
    ASSERT_TRUE(end.wait_for_messages(sent.size()));
    std::vector<Message> const received = end.messages();
    for (std::size_t i = 0; i < sent.size(); ++i) {
        ASSERT_TRUE(same(received[i], sent[i])) << i;
    }
    EncodedBatch const batch = large_batch(7, 9u << 20);
    Bytes const expected = framed(encode_message(batch));
    end.stream->send(batch);
    beast::flat_buffer came;
    while (came.size() < expected.size()) {
        browser.read(came);
        EXPECT_TRUE(browser.got_binary());
    }
    EXPECT_EQ(std::get<EncodedBatch>(messages_of(Bytes(static_cast<std::byte const*>(came.data().data()),
                                                       static_cast<std::byte const*>(came.data().data()) + came.size()))
                                         .at(0)),
              batch);
}

TEST_F(WebStream, ManyMessagesBothWays) {
    end.start(thread_);
    websocket::stream<Socket&> browser(browser_);
    browser.handshake("localhost", "/session");
    expect_messages_both_ways(browser, end);
    browser.close(websocket::close_code::normal);
    EXPECT_EQ(end.wait_for_close(), "the other side closed the connection");
}

TEST(WebStreamWithTls, ManyMessagesBothWays) {
    Identity const identity("web");
    HandshakeThread handshakes;
    IoThread thread;
    auto [one, two] = thread.connect();
    End end(tls_server_stream(std::move(two), identity.server(), handshakes.executor(),
                              std::make_shared<WebPage>(small_page())));
    end.start(thread);
    asio::ssl::context context(asio::ssl::context::tls_client);
    asio::ssl::stream<Socket> secure(std::move(one), context);
    secure.handshake(asio::ssl::stream_base::client);
    WebRequest const asked = request(http::verb::get, "/viewer.wasm");
    http::write(secure, asked);
    beast::flat_buffer buffer;
    http::response<http::string_body> answer;
    http::read(secure, buffer, answer);
    EXPECT_EQ(answer.body().size(), 70000u);
    websocket::stream<asio::ssl::stream<Socket>&> browser(secure); // by the same connection
    browser.handshake("localhost", "/session");
    expect_messages_both_ways(browser, end);
    end.stream->close();
    handshakes.stop();
}

TEST_F(WebStream, APageThatIsLeftIsNotCutOff) {
    for (auto const code :
         {websocket::close_code::going_away, websocket::close_code::normal, websocket::close_code::none}) {
        auto [one, two] = thread_.connect();
        End other(plain_stream(std::move(two), std::make_shared<WebPage>(small_page())));
        other.start(thread_);
        websocket::stream<Socket&> browser(one);
        browser.handshake("localhost", "/session");
        browser.close(code);
        EXPECT_TRUE(other.wait_for_close().has_value());
        EXPECT_EQ(other.stream->was_cut(), code != websocket::close_code::going_away) << code;
    }
}

TEST_F(WebStream, FramesGoThroughTheSameDoor) {
    end.start(thread_);
    Bytes const frame = framed(encode_message(Ack{1, 2, 3}));
    for (std::byte const byte : frame) {
        asio::write(browser_, asio::buffer(&byte, 1));
    }
    ASSERT_TRUE(end.wait_for_messages(1));
    end.stream->send(Ack{4, 5, 6});
    end.stream->close_after_sending();
    EXPECT_EQ(std::get<Ack>(messages_of(read_to_end(browser_)).at(0)).batch, 4u);
}

TEST_F(WebStream, TextIsRefused) {
    end.start(thread_);
    websocket::stream<Socket&> browser(browser_);
    browser.handshake("localhost", "/session");
    browser.text(true);
    browser.write(asio::buffer(std::string("hello")));
    EXPECT_TRUE(end.wait_for_close().has_value());
}

TEST_F(WebStream, TheLimitOfMessagesHoldsInsideAWebSocket) {
    end.start(thread_, 1000);
    websocket::stream<Socket&> browser(browser_);
    browser.handshake("localhost", "/session");
    browser.binary(true);
    browser.write(asio::buffer(Bytes(4, std::byte{1})));
    EXPECT_EQ(end.wait_for_close(), "a message of 16843009 bytes exceeds the limit of 1000");
}

TEST_F(WebStream, SeveralFilesByOneConnection) {
    end.start(thread_);
    write("GET / HTTP/1.1\r\nHost: localhost\r\n\r\nGET /viewer.wasm HTTP/1.1\r\nHost: localhost\r\n"
          "Connection: close\r\n\r\n");
    std::string const all = answer();
    EXPECT_NE(all.find("<p>a page</p>HTTP/1.1 200 OK"), std::string::npos);
    EXPECT_TRUE(all.ends_with(std::string(70000, 'w')));
    EXPECT_EQ(end.wait_for_close(), "the other side closed the connection");
    EXPECT_TRUE(end.stream->asks_for_files());
}

TEST_F(WebStream, HostileRequestsEnd) {
    for (std::string const& text :
         {std::string("HTTP/1.1 200 OK\r\n\r\n"), std::string("GET / HTTP/1.1\r\n\0\r\n\r\n", 21),
          "GET / HTTP/1.1\r\nX: " + std::string(20000, 'x'), std::string("AAAA\r\n\r\n"),
          std::string("GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n123456789"),
          std::string("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n")}) {
        auto [one, two] = thread_.connect();
        End other(plain_stream(std::move(two), std::make_shared<WebPage>(small_page())));
        other.start(thread_);
        boost::system::error_code ignored;
        asio::write(one, asio::buffer(text), ignored);
        read_to_end(one);
        EXPECT_TRUE(other.wait_for_close().has_value()) << text.substr(0, 40);
    }
}

TEST_F(WebStream, OneWhoIsToldSomethingWhileItAsksIsToldNothing) {
    end.start(thread_);
    write("GET / HTTP/1.1\r\n");
    ASSERT_TRUE(End::eventually([&] { return browser_.available() == 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(50)); // either order is right
    end.stream->send(Failure{"too many"});
    end.stream->close_after_sending();
    EXPECT_TRUE(End::eventually([&] { return end.stream->unsent_bytes() == 0; }));
    EXPECT_TRUE(end.is_released());
}

} // namespace
} // namespace framelet
