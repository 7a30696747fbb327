#include "lamella/system/whole_file.hpp"

#include "fixtures/expect_error.hpp"
#include "output_checks.hpp"
#include "system/atomic_directory.hpp"
#include "system/atomic_file.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <windows.h>

#include <filesystem>
#include <string>

namespace lamella::atomic_file_windows_cases {
namespace {

namespace fs = std::filesystem;
using test::Names;
using test::output_error_of;

constexpr const wchar_t* folder_variable = L"LAMELLA_TEST_FOLDER";

/// Another process that runs one test of this program, until it is killed.
class OtherProcess {
  public:
    OtherProcess(const fs::path& folder, const std::wstring& test) {
        wchar_t program[MAX_PATH];
        GetModuleFileNameW(nullptr, program, MAX_PATH);
        std::wstring line = L"\"" + std::wstring(program) +
                            L"\" --gtest_also_run_disabled_tests --gtest_filter=AtomicFile.DISABLED_" + test;
        SetEnvironmentVariableW(folder_variable, folder.c_str());
        STARTUPINFOW start{};
        start.cb = sizeof start;
        EXPECT_NE(CreateProcessW(nullptr, line.data(), nullptr, nullptr, FALSE, 0, nullptr, nullptr, &start,
                                 &process_),
                  0);
    }
    /// Waits until the process has created a file.
    void wait_for(const fs::path& file) const {
        while (!fs::exists(file) && WaitForSingleObject(process_.hProcess, 10) == WAIT_TIMEOUT) {
        }
    }
    void kill() {
        TerminateProcess(process_.hProcess, 9);
        WaitForSingleObject(process_.hProcess, INFINITE);
        CloseHandle(process_.hThread);
        CloseHandle(process_.hProcess);
    }

  private:
    PROCESS_INFORMATION process_{};
};

fs::path folder_of_this_process() {
    wchar_t folder[MAX_PATH];
    GetEnvironmentVariableW(folder_variable, folder, MAX_PATH);
    return folder;
}

TEST(AtomicFile, DISABLED_WritesUntilItIsKilled) {
    const fs::path folder = folder_of_this_process();
    AtomicFile file((folder / "a.cli").string());
    file.append(std::string(3'000'000, 'x'));
    AtomicDirectory directory((folder / "out").string(), [](const fs::path&) { return true; });
    directory.write("1", "x");
    write_whole_file((folder / "ready").string(), "x");
    Sleep(INFINITE);
}

TEST(AtomicFile, LeavesNothingBehindWhenTheProcessIsKilled) {
    const TemporaryFolder folder;
    write_file(folder.file("a.cli"), "old");
    OtherProcess other(folder.path(), L"WritesUntilItIsKilled");
    other.wait_for(folder.file("ready"));
    {
        // A process that is running keeps its folder.
        const AtomicDirectory second(folder.file("out"), [](const fs::path&) { return true; });
        EXPECT_EQ(folder.entries().size(), 5U) << "a.cli, its new bytes, ready, two folders";
    }
    other.kill();
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "old");
    EXPECT_EQ(folder.entries().size(), 3U) << "a.cli, ready, and a folder";
    {
        AtomicDirectory next(folder.file("out"), [](const fs::path&) { return true; });
        next.write("2", "y");
        next.commit();
    }
    EXPECT_EQ(folder.entries(), (Names{"a.cli", "out", "ready"}));
    EXPECT_FALSE(fs::exists(folder.file("out/1")));
}

TEST(AtomicFile, IsNamedInAnyScriptAndOverLongPaths) {
    const TemporaryFolder folder;
    fs::path deep = folder.path();
    for (int i = 0; i < 6; ++i) {
        deep /= fs::path(u8"Gehäuse und Böden " + std::u8string(40, u8'x'));
        fs::create_directory(fs::path(L"\\\\?\\" + deep.wstring()));
    }
    for (const char8_t* name : {u8"Zahnrad-ÄÖÜß.cli", u8"歯車.cli", u8"шестерня.cli", u8"⚙.cli"})
        for (const fs::path& in : {folder.path(), deep}) {
            const std::string path = (in / fs::path(name)).string();
            write_whole_file(path, "old");
            write_whole_file(path, "bytes");
            EXPECT_EQ(open_bytes(path).text(), "bytes") << path;
        }
    EXPECT_EQ(folder.entries().size(), 5U);
    std::error_code ignored; // the standard library cannot remove paths that are so long
    fs::remove_all(fs::path(L"\\\\?\\" + (folder.path() / folder.entries().front()).wstring()), ignored);
}

TEST(AtomicFile, ReplacesAFileThatOthersReadAndPermitToReplace) {
    if (GetProcAddress(GetModuleHandleW(L"ntdll.dll"), "wine_get_version") != nullptr)
        GTEST_SKIP() << "Wine does not rename over files that are open";
    const TemporaryFolder folder;
    const std::string path = folder.file("a.cli");
    write_file(path, "old");
    const HANDLE reader = CreateFileW(fs::path(path).c_str(), GENERIC_READ,
                                      FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                      OPEN_EXISTING, 0, nullptr);
    ASSERT_NE(reader, INVALID_HANDLE_VALUE);
    write_whole_file(path, "new");
    CloseHandle(reader);
    EXPECT_EQ(file_bytes(path), "new");
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

TEST(AtomicFile, NamesAFileThatAnotherProgramHasOpen) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.cli");
    write_file(path, "old");
    const HANDLE owner =
        CreateFileW(fs::path(path).c_str(), GENERIC_READ, 0, nullptr, OPEN_EXISTING, 0, nullptr);
    ASSERT_NE(owner, INVALID_HANDLE_VALUE);
    const std::string text = output_error_of([&] { const AtomicFile file(path); });
    EXPECT_NE(text.find("another program has the file open"), std::string::npos) << text;
    EXPECT_EQ(test::error_of(ErrorKind::input, [&] { (void)open_bytes(path); }),
              path + ": another program has locked this file; close it there");
    CloseHandle(owner);
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

TEST(AtomicFile, DoesNotReplaceAFileThatIsReadOnly) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.cli");
    write_file(path, "old");
    SetFileAttributesW(fs::path(path).c_str(), FILE_ATTRIBUTE_READONLY);
    const std::string text = output_error_of([&] { const AtomicFile file(path); });
    EXPECT_NE(text.find("write-protected"), std::string::npos) << text;
    SetFileAttributesW(fs::path(path).c_str(), FILE_ATTRIBUTE_NORMAL);
    EXPECT_EQ(file_bytes(path), "old");
}

TEST(AtomicFile, WritesToTheNullDevice) {
    write_whole_file("NUL", "gone");
    check_writable("NUL");
    EXPECT_EQ(AtomicFile("NUL").share(), "");
}

TEST(AtomicFile, TakesBothSeparatorsAndDriveLetters) {
    const TemporaryFolder folder;
    std::string path = folder.file("a.cli");
    EXPECT_EQ(path.at(1), ':');
    std::replace(path.begin(), path.end(), '\\', '/');
    write_whole_file(path, "bytes");
    EXPECT_EQ(open_bytes(path).text(), "bytes");
    const std::string text = output_error_of([] { const AtomicFile file("Q:/parts/a.cli"); });
    EXPECT_NE(text.find("does not exist"), std::string::npos) << text;
}

} // namespace
} // namespace lamella::atomic_file_windows_cases
