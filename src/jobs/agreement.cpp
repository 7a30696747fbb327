#include "jobs/agreement.hpp"

#include "lamella/core/error.hpp"

#include <new>
#include <string>
#include <vector>

namespace lamella {
namespace {

// The first character of a message: all is well, or the kind of an error, whose text follows.
constexpr char well = '-';

std::string message_of(const std::exception_ptr& failure) {
    const auto failed = [](ErrorKind kind, const std::string& text) {
        return static_cast<char>('a' + static_cast<int>(kind)) + text;
    };
    try {
        std::rethrow_exception(failure);
    } catch (const Error& error) {
        return failed(error.kind(), error.what());
    } catch (const std::bad_alloc&) {
        return failed(ErrorKind::limit, "memory ran out on one of the processes; use more of them");
    } catch (const std::exception& error) {
        return failed(ErrorKind::internal, error.what());
    }
}

ErrorKind kind_of(const std::string& message) {
    return static_cast<ErrorKind>(message.front() - 'a');
}

} // namespace

std::vector<std::string> Agreement::gather(std::string_view mine) {
    return meet(well + std::string(mine));
}

void Agreement::sum(std::span<std::uint64_t> values) {
    gather({});
    processes_.sum(values);
}

std::vector<std::string> Agreement::meet(const std::string& message) {
    std::vector<std::string> all = processes_.gather(message);
    const std::string* worst = nullptr;
    for (const std::string& one : all)
        if (one.front() != well && (worst == nullptr || (kind_of(*worst) == ErrorKind::cancelled &&
                                                         kind_of(one) != ErrorKind::cancelled)))
            worst = &one;
    if (worst != nullptr) {
        failed_ = true;
        throw Error(kind_of(*worst), worst->substr(1));
    }
    for (std::string& one : all)
        one.erase(0, 1);
    return all;
}

void Agreement::report(const std::exception_ptr& failure) {
    meet(message_of(failure));
    throw Error(ErrorKind::internal, "the processes do not know of an error");
}

} // namespace lamella
