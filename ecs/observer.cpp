#include "ecs/observer.h"

#include "ecs/world_internals.h"

#include <algorithm>

namespace limn {

void World::observe(Observer observer) {
    if (observer.component >= observed_.size()) {
        observed_.resize(component_count());
    }
    observed_[observer.component] |=
        static_cast<std::uint8_t>(1u << static_cast<unsigned>(observer.event));
    internals_->observers.push_back(std::make_unique<Observer>(std::move(observer)));
    refresh_observer_flags();
}

void World::refresh_observer_flags() {
    for (const auto& archetype : core_.archetypes) {
        const auto ids = archetype->components();
        archetype->observes_add = std::any_of(ids.begin(), ids.end(), [&](ComponentId id) {
            return observes(id, ObserverEvent::Add);
        });
        archetype->observes_remove = std::any_of(ids.begin(), ids.end(), [&](ComponentId id) {
            return observes(id, ObserverEvent::Remove);
        });
    }
    for (SparseSet* set : core_.sparse_list) {
        set->observes_add = observes(set->info().id, ObserverEvent::Add);
        set->observes_remove = observes(set->info().id, ObserverEvent::Remove);
    }
}

void World::notify(
    ObserverEvent event, std::span<const ComponentId> components,
    std::span<const Entity> entities) {
    bool called = false;
    std::vector<Entity> left;
    // By index: a function may register further observers.
    for (std::size_t i = 0; i < internals_->observers.size(); ++i) {
        const Observer& observer = *internals_->observers[i];
        if (observer.event != event
            || std::find(components.begin(), components.end(), observer.component)
                   == components.end()) {
            continue;
        }
        if (event == ObserverEvent::Remove) {
            const IterationGuard guard(core_, IterationLock::Plain);
            observer.function(*this, entities);
            continue;
        }
        std::span<const Entity> notified = entities;
        if (called) {
            // Earlier observers may have destroyed entities or removed the component again.
            left.clear();
            std::copy_if(
                entities.begin(), entities.end(), std::back_inserter(left),
                [&](Entity entity) { return has(entity, observer.component); });
            notified = left;
        }
        if (!notified.empty()) {
            observer.function(*this, notified);
            called = true;
        }
    }
}

void World::notify_all_removed() {
    std::vector<Entity> removed;
    for (std::size_t i = 0; i < internals_->observers.size(); ++i) {
        const Observer& observer = *internals_->observers[i];
        if (observer.event != ObserverEvent::Remove) {
            continue;
        }
        removed.clear();
        for (const auto& archetype : core_.archetypes) {
            if (archetype->has(observer.component)) {
                removed.insert(
                    removed.end(), archetype->entities().begin(), archetype->entities().end());
            }
        }
        if (const SparseSet* set = core_.sparse_set(observer.component); set != nullptr) {
            removed.insert(removed.end(), set->entities().begin(), set->entities().end());
        }
        if (!removed.empty()) {
            const IterationGuard guard(core_, IterationLock::Plain);
            observer.function(*this, removed);
        }
    }
}

}  // namespace limn
