"""The learned rewards of a training job, kept beside its controllers."""

from pathlib import Path

from hemma.errors import HemmaError
from hemma.irl.airl import ImitationState
from hemma.irl.learned_reward import LearnedReward, load_rewards, save_rewards
from hemma.irl.reward import ShapedReward
from hemma.results.store import Store
from hemma.rl.task import Task
from hemma.rl.training import Training


def learned_head(training: Training) -> ShapedReward | None:
    """The heads of all runs, and of all agents of a run, stacked; None where no reward is left behind."""
    state = training.state
    head = state.head if isinstance(state, ImitationState) else None
    return head if isinstance(head, ShapedReward) else None


def keep_rewards(training: Training, task: Task, label: str, store: Store) -> list[str]:
    """Write the learned rewards of a training job; the name of their file, if there are any."""
    head = learned_head(training)
    if head is None:
        return []
    file = reward_file(label, store)
    seeds = [int(seed) for seed in task.seed]
    rewards = LearnedReward(head, task.environment.scaler, training.state.average.space)
    save_rewards(store.folder / file, rewards, {"seeds": seeds})
    return [file]


def reward_file(label: str, store: Store) -> str:
    """Name, inside the folder, of the learned rewards of a training job."""
    return store.model(f"{label}.reward.safetensors")


def kept_rewards(label: str, store: Store) -> LearnedReward:
    """The learned rewards of a training job that was trained."""
    path: Path = store.folder / reward_file(label, store)
    if not path.is_file():
        raise HemmaError(
            f"{path}: expected the learned rewards of {label}, there are none; train it again (AIRL alone "
            "leaves a reward behind, and folders of earlier versions do not hold it)"
        )
    return load_rewards(path)
