#include "z_list.hpp"

#include "lamella/core/error.hpp"

#include "numbers.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

namespace lamella::app {
namespace {

/// The heights read so far, at most as many as their planes fit the memory.
class Heights {
  public:
    Heights(std::string name, std::uint64_t max_memory) : name_(std::move(name)), max_memory_(max_memory) {}

    /// `location` is called only for an error.
    template <class Location>
    void append(double value, const Location& location) {
        constexpr std::uint64_t few = 100'000;
        constexpr std::uint64_t plane_bytes = 500;
        if (max_memory_ != 0 && z_.size() >= std::max(few, max_memory_ / plane_bytes))
            throw Error(
                ErrorKind::limit,
                fmt::format("{}: lists more than {} heights, whose layers take more than the {} bytes of "
                            "--max-memory",
                            name_, z_.size(), max_memory_));
        if (!z_.empty() && !(value > z_.back()))
            throw Error(ErrorKind::usage,
                        fmt::format("{}: {} is not above the height before it, {}; heights must ascend",
                                    location(), value, z_.back()));
        z_.push_back(value);
    }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::size_t size() const noexcept { return z_.size(); }
    [[nodiscard]] std::vector<double> take() { return std::move(z_); }

  private:
    std::string name_;
    std::uint64_t max_memory_;
    std::vector<double> z_;
};

/// Takes the items of a JSON list one by one, so that only their values are held.
class ListItems final : public nlohmann::json_sax<nlohmann::json> {
  public:
    explicit ListItems(Heights& z) : z_(z) {}

    bool number_integer(number_integer_t value) override { return add(static_cast<double>(value)); }
    bool number_unsigned(number_unsigned_t value) override { return add(static_cast<double>(value)); }
    bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
    bool start_array(std::size_t /*size*/) override { return depth_++ == 0 ? true : refuse(); }
    bool end_array() override { return true; }
    bool null() override { return refuse(); }
    bool boolean(bool /*value*/) override { return refuse(); }
    bool string(string_t& /*value*/) override { return refuse(); }
    bool binary(binary_t& /*value*/) override { return refuse(); }
    bool start_object(std::size_t /*size*/) override { return refuse(); }
    bool key(string_t& /*value*/) override { return refuse(); }
    bool end_object() override { return refuse(); }
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                     const nlohmann::json::exception& /*error*/) override {
        throw Error(ErrorKind::usage, fmt::format("{}: begins as a JSON list but is none", z_.name()));
    }

  private:
    [[nodiscard]] std::string item() const { return fmt::format("{}: item {}", z_.name(), z_.size() + 1); }
    bool add(double value) {
        z_.append(value, [this] { return item(); });
        return true;
    }
    [[noreturn]] bool refuse() const {
        throw Error(ErrorKind::usage, fmt::format("{} of the list is not a number", item()));
    }

    Heights& z_;
    int depth_ = 0;
};

void add_lines(Heights& z, std::string_view content) {
    std::size_t line = 0;
    while (!content.empty()) {
        ++line;
        const std::size_t end = content.find('\n');
        std::string_view text = content.substr(0, end);
        content.remove_prefix(end == std::string_view::npos ? content.size() : end + 1);
        text = text.substr(0, text.find('#'));
        while (!text.empty() && (text.back() == '\r' || text.back() == ' ' || text.back() == '\t'))
            text.remove_suffix(1);
        if (text.empty())
            continue;
        const auto location = [&] {
            return fmt::format("{}:{}", z.name(), line);
        };
        double value = 0;
        try {
            value = parse_number(text);
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("{}: {}", location(), error.what()));
        }
        z.append(value, location);
    }
}

} // namespace

std::vector<double> read_z_list(const std::string& path, std::uint64_t max_memory) {
    constexpr std::uint64_t few = std::uint64_t{1} << 20;
    const std::string content = read_text_file(path, max_memory == 0 ? 0 : std::max(few, max_memory / 4));
    Heights z(input_name(path), max_memory);
    const std::size_t first = content.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && content[first] == '[') {
        ListItems items(z);
        nlohmann::json::sax_parse(content, &items);
    } else {
        add_lines(z, content);
    }
    if (z.size() == 0)
        throw Error(ErrorKind::input, fmt::format("{}: lists no height to cut at", z.name()));
    return z.take();
}

} // namespace lamella::app
