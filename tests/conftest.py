"""What every test sees: the profiles of hypothesis."""

from hypothesis import HealthCheck, settings

settings.register_profile(
    "hemma", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("hemma")
