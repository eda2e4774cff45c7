// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Body.hpp>

#include <boost/iterator/filter_iterator.hpp>

namespace yade {

/// Bodies by id; the place of an erased body holds a null pointer, which iterators skip.
class BodyContainer : public Serializable {
	YADE_STOCK_SERIALIZABLE(BodyContainer)

	struct isNonEmptySharedPtr {
		bool operator()(const shared_ptr<Body>& body) const { return static_cast<bool>(body); }
	};
	using ContainerT = std::vector<shared_ptr<Body>>;
	using iterator = boost::filter_iterator<isNonEmptySharedPtr, ContainerT::iterator>;

	ContainerT body;

private:
	bool dirty;

public:
	/// False: the collider brings its lists up to date with the bodies inserted and erased. A collider that has no lists yet makes them only then.
	bool checkedByCollider;

private:
	abi::Opaque<50, 200> listsForCollider;

public:
	BodyContainer() = delete;

	iterator begin();
	iterator end();
	size_t size() const; ///< highest id + 1, erased bodies included
	bool exists(Body::id_t id) const;
	shared_ptr<Body>& operator[](unsigned int id);
	const shared_ptr<Body>& operator[](unsigned int id) const;
};

} // namespace yade
