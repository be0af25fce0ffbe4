#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace treacle {

/// Prints to stdout; nothing is thrown where that fails, and what follows is lost, too.
void printText(const std::string& text);
template <class... T>
void print(fmt::format_string<T...> format, T&&... values) {
  printText(fmt::format(format, std::forward<T>(values)...));
}

/// Hands everything printed up to now to the system.
void flushPrinted();

/// Prints to stderr, or nothing where that fails.
void printError(const std::string& text);

/// What kept stdout from being written up to now, "No space left on device"; empty where nothing did, or where
/// nobody reads any more.
std::string printFailure();

/// Files that are opened later must not take the places of stdin, stdout and stderr: what is printed would land in
/// them. Those that are closed become the null device.
void openClosedStreams();

}  // namespace treacle
