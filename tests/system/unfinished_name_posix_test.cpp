#include "lamella/core/error.hpp"
#include "lamella/system/whole_file.hpp"

#include "fixtures/child_process.hpp"
#include "system/unfinished_name.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace lamella::unfinished_name_cases {
namespace {

// A process that has begun to end cannot go back, so each of these tests has one of its own.

TEST(UnfinishedName, IsRemovedUnlessItWasWithdrawn) {
    const TemporaryFolder folder;
    for (const char* name : {"unfinished", "finished", "foreign"})
        write_file(folder.file(name), "bytes");
    std::filesystem::create_directory(folder.file("folder"));
    for (int i = 0; i < 300; ++i)
        write_file(folder.file("folder/" + std::to_string(i)), "");
    EXPECT_EQ(exit_code_of_child([&] {
                  UnfinishedName unfinished;
                  UnfinishedName finished;
                  UnfinishedName whole_folder;
                  const bool announced = unfinished.announce(folder.file("unfinished")) &&
                                         finished.announce(folder.file("finished")) &&
                                         whole_folder.announce(folder.file("folder"));
                  const bool withdrawn = finished.withdraw();
                  remove_unfinished();
                  const bool late = unfinished.withdraw();
                  ::_exit(announced && withdrawn && !late ? 0 : 1);
              }),
              0);
    EXPECT_EQ(folder.entries(), (std::vector<std::string>{"finished", "foreign"}));
}

TEST(UnfinishedName, IsRemovedWhereTheTimeIsUpWhileItIsCreated) {
    const TemporaryFolder folder;
    EXPECT_EQ(exit_code_of_child([&] {
                  std::signal(SIGXCPU, [](int) {
                      remove_unfinished();
                      ::_exit(0);
                  });
                  UnfinishedName name;
                  {
                      const UnfinishedName::Creation creation;
                      std::filesystem::create_directory(folder.file("folder"));
                      ::raise(SIGXCPU);
                      static_cast<void>(name.announce(folder.file("folder")));
                  }
                  ::_exit(1);
              }),
              0);
    EXPECT_EQ(folder.entries(), std::vector<std::string>());
}

TEST(UnfinishedName, IsNotAnnouncedOnceTheProcessEnds) {
    const TemporaryFolder folder;
    write_file(folder.file("late"), "bytes");
    EXPECT_EQ(exit_code_of_child([&] {
                  remove_unfinished();
                  UnfinishedName late;
                  const bool announced = late.announce(folder.file("late"));
                  bool refused = false;
                  try {
                      const UnfinishedName::Creation creation;
                  } catch (const Error& error) {
                      refused = error.kind() == ErrorKind::cancelled;
                  }
                  ::_exit(!announced && refused ? 0 : 1);
              }),
              0);
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"late"}) << "its owner removes it";
}

TEST(UnfinishedName, OfManyThreadsAreAllRemoved) {
    const TemporaryFolder folder;
    EXPECT_EQ(exit_code_of_child([&] {
                  std::vector<std::unique_ptr<UnfinishedName>> names;
                  for (int i = 0; i < 64; ++i)
                      names.push_back(std::make_unique<UnfinishedName>());
                  std::vector<std::thread> threads;
                  for (int t = 0; t < 4; ++t)
                      threads.emplace_back([&, t] {
                          for (int i = t; i < 64; i += 4) {
                              const UnfinishedName::Creation creation;
                              const std::string path = folder.file(std::to_string(i));
                              write_file(path, "bytes");
                              if (!names[static_cast<std::size_t>(i)]->announce(path))
                                  ::_exit(2);
                              if (i % 2 == 0 && !names[static_cast<std::size_t>(i)]->withdraw())
                                  ::_exit(3);
                          }
                      });
                  for (std::thread& thread : threads)
                      thread.join();
                  remove_unfinished();
                  ::_exit(0);
              }),
              0);
    EXPECT_EQ(folder.entries().size(), 32U);
}

} // namespace
} // namespace lamella::unfinished_name_cases
