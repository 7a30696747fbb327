// The minimal work of a slicer of small parts: reads files and writes an answer that exists already. Usage:
// read_and_write ANSWER OUTPUT-FOLDER INPUT, which is a file or a folder of them.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 4)
        return 2;
    namespace fs = std::filesystem;
    const std::string answer = bytes_of(argv[1]);
    const auto read_and_write = [&](const fs::path& input) {
        const bool read = !bytes_of(input).empty();
        std::ofstream file(fs::path(argv[2]) / (input.stem().string() + ".cli"), std::ios::binary);
        file.write(answer.data(), static_cast<std::streamsize>(answer.size()));
        file.close();
        return read && file.good();
    };
    const fs::path inputs = argv[3];
    if (!fs::is_directory(inputs))
        return read_and_write(inputs) ? 0 : 1;
    bool right = true;
    for (const fs::directory_entry& entry : fs::directory_iterator(inputs))
        right = read_and_write(entry.path()) && right;
    return right ? 0 : 1;
}
