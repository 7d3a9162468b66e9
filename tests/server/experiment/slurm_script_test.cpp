// tests/server/experiment/slurm_script_test.cpp: the texts for Slurm, and its answers.
#include "server/experiment/sweep/slurm_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace server::sweep {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

TEST(SlurmScript, TellsTasksAsRanges) {
  EXPECT_EQ(array_text({3}), "3");
  EXPECT_EQ(array_text({0, 1, 2, 5, 7, 8}), "0-2,5,7-8");
}

TEST(SlurmScript, ReadsTheQueue) {
  EXPECT_THAT(tasks_in_queue(""), IsEmpty());
  EXPECT_THAT(tasks_in_queue("4\n0\n17"), ElementsAre(0, 4, 17));
  EXPECT_THAT([] { tasks_in_queue("4\nN/A"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("squeue answered 'N/A'")));
}

TEST(SlurmScript, NamesTheFolderTheOptionsAndTheControllers) {
  const std::string script = script_of({.program = "/opt/tautline",
                                        .folder = "/data/it's",
                                        .tasks = 12,
                                        .options = {"--time=1:00:00"},
                                        .controllers = {"--controller", "mine=python3 mine.py"}},
                                       "near");
  EXPECT_THAT(script,
              AllOf(HasSubstr("#SBATCH --time=1:00:00\n"),
                    HasSubstr("#SBATCH --signal=B:USR1@120\n"),
                    HasSubstr("out='/data/it'\\''s'\n"),
                    HasSubstr("tasks=12\n"),
                    HasSubstr("controllers=('--controller' 'mine=python3 mine.py')\n")));
}

TEST(SlurmScript, AJobHasTheNameOfItsFolder) {
  EXPECT_EQ(job_name("near", "/data/a"), job_name("near", "/data/a"));
  EXPECT_NE(job_name("near", "/data/a"), job_name("near", "/data/b"));
}

}  // namespace
}  // namespace server::sweep
