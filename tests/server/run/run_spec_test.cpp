// tests/server/run/run_spec_test.cpp: invalid run specs.
#include "server/run/run_spec.hpp"

#include <gtest/gtest.h>

#include "server/run/json_reader.hpp"

namespace server {
namespace {

TEST(RunSpec, RefusesFullContractionOfAViaThatIsKept) {
  RunOverrides overrides;
  overrides.controller = "via_kept";
  overrides.parameters = {{"k_c", 1.0}};
  try {
    make_spec({}, overrides);
    FAIL() << "made";
  } catch (const DocumentError& e) {
    EXPECT_STREQ(e.what(),
                 "parameters: k_c must be below 1 with the controller via_kept: at 1 its via point "
                 "swings from side to side and never settles");
  }
  overrides.parameters = {{"k_c", 0.95}};
  EXPECT_EQ(make_spec({}, overrides).scenario.controller, "via_kept");
  overrides.controller = "modified";
  overrides.parameters = {{"k_c", 1.0}};
  EXPECT_EQ(make_spec({}, overrides).scenario.controller, "modified");
}

}  // namespace
}  // namespace server
