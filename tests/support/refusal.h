#pragma once
#include <string>

#include "scenes/model/error.h"

namespace reemit::test {

/// What the error says that `action` throws; "accepted" if it throws none.
template <class Error = InputError, class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace reemit::test
