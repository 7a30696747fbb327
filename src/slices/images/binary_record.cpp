#include "slices/images/binary_record.hpp"

#include "container/parse_number.hpp"

#include <cstddef>

namespace lamella {

double BinaryRecord::shortest(float value) {
    const std::string text = fmt::format("{}", value);
    double number = 0;
    parse_number(text.data(), text.data() + text.size(), number);
    return number;
}

} // namespace lamella
