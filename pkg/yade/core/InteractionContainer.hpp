// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/BodyContainer.hpp>
#include <core/Interaction.hpp>

namespace yade {

/// All interactions, in an order that depends on the history of the run.
class InteractionContainer : public Serializable {
	// No pyRegisterClass: the libraries do not export one, Python sees a wrapper instead.
public:
	~InteractionContainer() override;
	InteractionContainer() = delete;

	friend struct abi::PrivateMembers;

private:
	using ContainerT = vector<shared_ptr<Interaction>>;

	ContainerT linIntrs;
	abi::Opaque<48, 80> sortedAndBodies;
	size_t currSize;
	abi::Opaque<88, 128> emptyAndSaved;

public:
	bool dirty;

private:
	abi::Opaque<129, 192> lockAndCollider;

public:
	using iterator = ContainerT::iterator;
	using const_iterator = ContainerT::const_iterator;

	iterator begin() { return linIntrs.begin(); }
	iterator end() { return linIntrs.end(); }
	const_iterator begin() const { return linIntrs.begin(); }
	const_iterator end() const { return linIntrs.end(); }
	size_t size() { return currSize; }

	shared_ptr<Interaction>& operator[](size_t index) { return linIntrs[index]; }
	const shared_ptr<Interaction>& operator[](size_t index) const { return linIntrs[index]; }

	/// A null pointer if there is none.
	const shared_ptr<Interaction>& find(Body::id_t id1, Body::id_t id2);
	bool insert(const shared_ptr<Interaction>& interaction);
	bool erase(Body::id_t id1, Body::id_t id2, int position = -1);
	/// Takes geometry and physics from the interaction; the collider decides whether it stays as a potential one.
	void requestErase(Body::id_t id1, Body::id_t id2);
	void requestErase(const shared_ptr<Interaction>& interaction);
	void requestErase(Interaction* interaction);
};

} // namespace yade
