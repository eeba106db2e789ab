#pragma once
#include <initializer_list>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace reemit::test {

/// Runs `action`, which must throw an InputError whose message holds all `parts`.
template <class Action>
void expect_input_error(const Action& action, std::initializer_list<const char*> parts) {
  const std::string message = refusal_of(action);
  for (const char* part : parts) EXPECT_THAT(message, testing::HasSubstr(part));
}

}  // namespace reemit::test
