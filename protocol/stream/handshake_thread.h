// The thread that computes a server's TLS handshakes: to sign one takes milliseconds with a long RSA key, and strangers
// ask for as many as they like. In: handshakes of streams, one after the other. Out: the same, done.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <thread>

namespace framelet {

/// Is to live longer than the io_context of the streams that it works for, and to be stopped before that ends.
class HandshakeThread {
public:
    HandshakeThread();
    ~HandshakeThread();
    HandshakeThread(HandshakeThread const&) = delete;
    HandshakeThread& operator=(HandshakeThread const&) = delete;

    boost::asio::any_io_executor executor() { return io_.get_executor(); }
    /// Ends the thread. What it has not begun by then is done here, where nothing has been stopped that it needs.
    void stop();

private:
    void run();

    boost::asio::io_context io_{1};
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> stays_{io_.get_executor()};
    std::thread thread_;
};

} // namespace framelet
