// server/run/planning_thread.cpp: a future for each question.
#include "server/run/planning_thread.hpp"

#include <chrono>
#include <utility>

namespace server {
namespace {

bool has_come(const std::future<algo::ReachPlan>& plan) {
  return plan.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void PlanningThread::ask(const algo::MobileArm& body, const algo::ReachQuestion& question) {
  std::erase_if(abandoned_, has_come);
  if (coming_.valid()) abandoned_.push_back(std::move(coming_));
  coming_ = std::async(std::launch::async, [body, question] { return answer(body, question); });
}

bool PlanningThread::ready() {
  return coming_.valid() && has_come(coming_);
}

algo::ReachPlan PlanningThread::take() {
  return coming_.get();
}

}  // namespace server
