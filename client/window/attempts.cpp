#include "client/window/attempts.h"

#include <thread>
#include <utility>

#include "client/window/window.h"
#include "common/error.h"
#include "common/program_line.h"
#include "protocol/connection/token_refusal.h"

namespace framelet {

std::unique_ptr<ClientCore> connect_for_window(ConnectionOptions const& options) {
    return std::make_unique<ClientCore>(options, [] { Window::wake(); });
}

std::string Attempts::message() const {
    std::string const server = options_.server.text();
    if (!has_failed()) {
        return "connecting to " + server + " ...";
    }
    if (unknown_) {
        return "No authority vouches for the certificate of " + server +
               ", which is new here.\n\nIts SHA-256 fingerprint is\n" + unknown_->fingerprint +
               "\n\nTrust it if the server printed the same at its start. No token has been sent.";
    }
    return (is_refused_ ? "cannot connect to " + server : "waiting for " + server + " ...") + "\n\n" + failure_ +
           (field_at_fault() == ServerField::none ? "\n\nR or Enter: try now" : "\n\nEnter: try now") +
           "     Ctrl+Q: quit";
}

ServerField Attempts::field_at_fault() const {
    return !has_failed() || unknown_ ? ServerField::none
           : is_token_wrong_         ? ServerField::token
           : is_typed_               ? ServerField::address
                                     : ServerField::none;
}

void Attempts::hurry() {
    back_off_.reset();
    next_ = Clock::now();
    is_refused_ = false;
    is_token_wrong_ = false;
    unknown_.reset();
}

void Attempts::trust() {
    try {
        std::exchange(unknown_, std::nullopt).value().trust();
        hurry();
    } catch (InputError const& error) {
        note(error.what(), error.what());
    }
}

std::unique_ptr<ClientCore> Attempts::poll(bool is_refusal_fatal) {
    if (!attempt_.valid() && !is_refused_ && Clock::now() >= next_) {
        std::packaged_task<std::unique_ptr<ClientCore>()> task(
            [options = options_] { return connect_for_window(options); });
        attempt_ = task.get_future();
        std::thread([task = std::move(task)]() mutable {
            task();
            Window::wake(); // whatever has come of it
        }).detach();
    }
    if (!attempt_.valid() || attempt_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return nullptr;
    }
    try {
        return attempt_.get();
    } catch (UnknownCertificate const& unknown) {
        is_refused_ = true;
        unknown_ = unknown;
        note(unknown.what(), "no authority vouches for the certificate of the server at " + unknown.server +
                                 ", and it is new here. Its SHA-256 fingerprint is " + unknown.fingerprint +
                                 ": the window asks whether to trust it");
    } catch (TokenRefusal const& refusal) {
        is_refused_ = true;
        is_token_wrong_ = true;
        if (is_refusal_fatal) {
            throw;
        }
        note(refusal.complaint + ": type it below", refusal.complaint + ": the window asks for it");
    } catch (std::exception const& error) {
        is_refused_ = dynamic_cast<ConnectionError const*>(&error) == nullptr ||
                      dynamic_cast<ConnectionRefusal const*>(&error) != nullptr; // else it may help to try again
        if (is_refused_ && is_refusal_fatal) {
            throw;
        }
        is_token_wrong_ = false;
        note(error.what(), error.what());
    }
    if (!is_refused_) {
        auto const pause = std::chrono::duration<double>(back_off_.next(std::generate_canonical<double, 32>(random_)));
        next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
    }
    return nullptr;
}

void Attempts::note(std::string const& failure, std::string const& line) {
    if (failure_ != failure) {
        failure_ = failure;
        print_line("framelet-viewer", line + (is_refused_ ? "" : "; waiting for it"));
    }
}

} // namespace framelet
