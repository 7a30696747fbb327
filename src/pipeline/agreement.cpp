#include "pipeline/agreement.hpp"

#include <new>
#include <string>
#include <vector>

namespace lamella {
namespace {

/// Returns the kind as one character, then the text; "" if nothing was thrown.
std::string outcome_of(const std::exception_ptr& failure) {
    const auto failed = [](ErrorKind kind, const std::string& text) {
        return static_cast<char>('a' + static_cast<int>(kind)) + text;
    };
    if (!failure)
        return {};
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

ErrorKind kind_of(const std::string& outcome) {
    return static_cast<ErrorKind>(outcome.front() - 'a');
}

} // namespace

void agree(Communicator& processes, const std::exception_ptr& failure) {
    const std::vector<std::string> outcomes = processes.gather(outcome_of(failure));
    const std::string* worst = nullptr;
    for (const std::string& outcome : outcomes)
        if (!outcome.empty() && (worst == nullptr || (kind_of(*worst) == ErrorKind::cancelled &&
                                                      kind_of(outcome) != ErrorKind::cancelled)))
            worst = &outcome;
    if (worst != nullptr)
        throw Error(kind_of(*worst), worst->substr(1));
}

} // namespace lamella
