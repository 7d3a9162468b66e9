// server/experiment/judge.cpp: finds judges and columns by name.
#include "server/experiment/judge.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace server::experiment {

double JudgedRun::setting(std::string_view name, double otherwise) const {
  const auto found = settings.find(name);
  return found == settings.end() ? otherwise : found->second;
}

const JudgeInfo& find_judge(std::string_view name) {
  const std::span<const JudgeInfo> table = judge_table();
  const auto found = std::ranges::find(table, name, &JudgeInfo::name);
  if (found != table.end()) return *found;
  std::string known;
  for (const JudgeInfo& each : table) {
    known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
  }
  throw std::invalid_argument(fmt::format("no judge is called '{}'; there are {}", name, known));
}

const Column* find_column(std::string_view name) {
  for (const JudgeInfo& judge : judge_table()) {
    const auto found = std::ranges::find(judge.columns, name, &Column::name);
    if (found != judge.columns.end()) return &*found;
  }
  return nullptr;
}

}  // namespace server::experiment
