#pragma once
#include <initializer_list>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"

namespace reemit::test {

/// Runs `action`, which must throw an InputError whose message holds all `parts`.
template <class Action>
void expect_input_error(Action action, std::initializer_list<const char*> parts) {
  try {
    action();
  } catch (const InputError& error) {
    for (const char* part : parts) EXPECT_THAT(error.what(), testing::HasSubstr(part));
    return;
  }
  ADD_FAILURE() << "no InputError; expected one that says: " << *parts.begin();
}

}  // namespace reemit::test
