// SPDX-License-Identifier: GPL-2.0-or-later
#include "DeferredError.hpp"
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace yade {
namespace {
struct Report {
	std::pair<int, int> ids;
	std::string message;
};
std::mutex reportsGuard;
std::map<const Scene*, Report> reports; // almost always empty
} // namespace

void DeferredError::report(const Scene* scene, int id1, int id2, const std::string& message)
{
	const std::lock_guard<std::mutex> lock(reportsGuard);
	const std::pair<int, int> ids(id1, id2);
	const auto known = reports.find(scene);
	if (known == reports.end())
		reports[scene] = {ids, message};
	else if (ids < known->second.ids)
		known->second = {ids, message};
}

void DeferredError::raise(const Scene* scene)
{
	const std::lock_guard<std::mutex> lock(reportsGuard);
	const auto known = reports.find(scene);
	if (known == reports.end()) return;
	const std::string message = known->second.message;
	reports.erase(known);
	throw std::runtime_error(message);
}

} // namespace yade
