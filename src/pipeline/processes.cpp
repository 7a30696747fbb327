#include "lamella/pipeline/processes.hpp"

#include "lamella/core/error.hpp"

#include <algorithm>

namespace lamella {
namespace {

class Alone final : public Communicator {
  public:
    [[nodiscard]] std::size_t process() const noexcept override { return 0; }
    [[nodiscard]] std::size_t size() const noexcept override { return 1; }
    void sum(std::span<std::uint64_t>) override {}
    [[nodiscard]] std::vector<std::string> gather(std::string_view mine) override {
        return {std::string(mine)};
    }
    [[nodiscard]] std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) override {
        return {outgoing.begin(), outgoing.end()};
    }
    void exchange(std::span<const std::span<const std::byte>> outgoing,
                  std::span<const std::span<std::byte>> incoming) override {
        std::copy(outgoing.front().begin(), outgoing.front().end(), incoming.front().begin());
    }
    void send(std::size_t, std::string_view) override {
        throw Error(ErrorKind::internal, "a message to another process, and there is none");
    }
    [[nodiscard]] std::string receive(std::size_t) override {
        throw Error(ErrorKind::internal, "a message from another process, and there is none");
    }
};

} // namespace

Communicator& alone() noexcept {
    static Alone process;
    return process;
}

} // namespace lamella
