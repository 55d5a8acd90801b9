"""What holds for every test."""

from hypothesis import HealthCheck, settings

# how long an example takes says how busy the machine is, and nothing of the law
settings.register_profile("drivelint", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("drivelint")
