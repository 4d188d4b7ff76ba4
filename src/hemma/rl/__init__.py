"""Reinforcement learning: scaled states, policies, the learner's environment, PPO."""
