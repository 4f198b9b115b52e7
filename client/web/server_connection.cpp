// The web build's ServerConnection: all of it is called in the page's one thread.
#include "protocol/connection/server_connection.h"

#include <utility>

#include "client/web/page_connection.h"
#include "protocol/stream/message_frame.h"

namespace framelet {

struct ServerConnection::Impl {
    PageConnection& page;
};

ServerConnection::ServerConnection(ConnectionOptions const& options, Handlers handlers)
    : impl_(std::make_unique<Impl>(Impl{*static_cast<PageConnectionOptions const&>(options).page})) {
    impl_->page.handlers = std::move(handlers);
}

ServerConnection::~ServerConnection() {
    send(Failure{"it was closed"});
    impl_->page.handlers = {};
}

Welcome const& ServerConnection::welcome() const {
    return impl_->page.welcome;
}

void ServerConnection::send(Message const& message) {
    if (impl_->page.is_open) {
        impl_->page.send(frame_of(message));
    }
}

void ServerConnection::acknowledge(Ack const&) {} // see BatchAnswers

bool ServerConnection::all_sent() const {
    return impl_->page.all_sent;
}

} // namespace framelet
