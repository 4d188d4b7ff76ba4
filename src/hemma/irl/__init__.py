"""Inverse reinforcement learning: the learned reward, the discriminator and Algorithm 1."""
