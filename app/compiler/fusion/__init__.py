"""Operations become passes: which of them share one."""
