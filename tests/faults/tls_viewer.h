// A viewer as RawViewer, that speaks TLS and believes whatever certificate it is shown. For tests only.
#pragma once

#include <memory>

#include <openssl/ssl.h>

#include "tests/session/raw_viewer.h"

namespace framelet {

/// SIGPIPE must be ignored: OpenSSL writes to a connection that has ended too.
class TlsViewer : public RawViewer {
public:
    TlsViewer(std::uint16_t port, Hello const& hello,
              boost::asio::ip::address_v4 const& source = boost::asio::ip::address_v4::loopback())
        : RawViewer(port, Silent{}, source) {
        SSL_set_fd(tls_.get(), socket());
        is_secure_ = SSL_connect(tls_.get()) == 1;
        send(hello);
    }

protected:
    void write(Bytes const& bytes) override {
        if (is_secure_) {
            SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()));
        }
    }
    bool read(void* to, std::size_t size) override {
        auto* const bytes = static_cast<std::byte*>(to);
        for (std::size_t done = 0; done < size;) {
            int const read = is_secure_ ? SSL_read(tls_.get(), bytes + done, static_cast<int>(size - done)) : 0;
            if (read <= 0) {
                return false;
            }
            done += static_cast<std::size_t>(read);
        }
        return true;
    }

private:
    std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> const context_{SSL_CTX_new(TLS_client_method()), SSL_CTX_free};
    std::unique_ptr<SSL, decltype(&SSL_free)> const tls_{SSL_new(context_.get()), SSL_free};
    bool is_secure_ = false;
};

} // namespace framelet
