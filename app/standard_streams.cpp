#include "standard_streams.hpp"

namespace lamella::app {

std::string input_name(const std::string& path) {
    return path == "-" ? "standard input" : path;
}

std::string output_name(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

} // namespace lamella::app
