// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "db/types/errors.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace phonomime::test {

// The message of the InputError that `action` throws; fails where it throws nothing or another
// thing.
inline std::string input_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return {};
  }
  ADD_FAILURE() << "no error";
  return {};
}

// The same, and the message has this part.
inline void expect_error(const std::function<void()>& action, const std::string& part) {
  const std::string message = input_error(action);
  EXPECT_NE(message.find(part), std::string::npos)
      << "message: " << message << "\nwithout: " << part;
}

} // namespace phonomime::test
