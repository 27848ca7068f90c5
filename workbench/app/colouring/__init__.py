"""Which colour stands for which value: ranges, bars, legends."""
